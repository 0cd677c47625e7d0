#pragma once

#include <vector>

#include "lattice/cutout.h"
#include "lattice/relaxation.h"
#include "lattice/site_fields.h"
#include "verification/bridge/subject.h"

namespace latcon::claims
{

/// Sheet with a cut, between edges held at a homogeneous deformation.
struct CutSheet
{
  lattice::Cutout cutout;
  double size;         ///< R of the hole, or length of the notch [m]
  double length;       ///< of the sheet, before rounding to whole rows [m]
  double height;       ///< likewise [m]
  lattice::Edges held; ///< the other edges are free
  Eigen::Matrix2d F;   ///< of the held edges [-]

  bool is_hole() const { return std::holds_alternative<lattice::RoundHole>(cutout); }
};

/// Sheet of about 5 R by 4 R with a hole in its middle, all edges held. The middle is a site, so that the staircase of
/// the rim has the sixfold symmetry of the lattice and no oval in it; the radius is R [m] to half a spacing, the one
/// whose rim is the least hexagonal (theory-comparison.md, section "Edges of the continuum").
CutSheet sheet_with_hole(const bridge::Subject &subject, double R, const Eigen::Matrix2d &F);

/// Sheet of 4 a by 4 a, cut along y = 0 by about a [m] from its left edge, which is free; the others are held. The cut
/// ends a little behind a site, so that all lattices have the same tip.
CutSheet sheet_with_notch(const bridge::Subject &subject, double a, const Eigen::Matrix2d &F);

/// Lattice of a CutSheet in equilibrium, and the quantities that are compared.
struct CutLattice
{
  CutSheet sheet;
  lattice::TriangularLattice lattice;
  lattice::State state;
  lattice::SiteFields fields;
  lattice::Relaxation relaxation;

  /// A site whose fields are compared.
  struct Site
  {
    std::size_t place;
    bool has_all_bonds; ///< or stands at a free edge, a rim, a lip
  };
  std::vector<Site> sites; ///< those that are free to move

  // Reference: the whole sheet, homogeneously deformed.
  double homogeneous_energy;     ///< W of a site with all its bonds [J/m^3]
  Eigen::Matrix2d homogeneous_P; ///< first Piola stress of such a site [Pa]
  // Sheet in equilibrium less the reference: bonds between held sites, which represent no definite area, cancel.
  double energy_change;            ///< [J/m]
  Eigen::Vector2d reaction_change; ///< force on the held right edge along x, on the top edge along y [N/m]
  // X [m] to which the homogeneous sheet reaches on its left if that is free: by its bonds' energy, and by their force
  // along y. They differ, since bonds across the edge are missing and those along it are not.
  double left_of_energy, left_of_force;
};

/// Relaxes the lattice to a largest force on a free site of 1e-8 mu d. @throws std::runtime_error if the lattice does not relax
CutLattice relaxed_lattice(const bridge::Subject &subject, const CutSheet &sheet);

} // namespace latcon::claims
