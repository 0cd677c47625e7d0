#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "continuum/constitution.h"
#include "lattice/cutout.h"
#include "lattice/relaxation.h"
#include "lattice/site_fields.h"
#include "verification/bridge/equivalent_sheet.h"
#include "verification/bridge/subject.h"
#include "verification/claims/rows.h"

namespace latcon::claims
{

/// Claim `prestretch`: a lattice sheet between held edges, relaxed from noise, and a finite element sheet of the same
/// size with the same edge displacements, agree in energy density, edge tractions and fields; exactly (to solver
/// tolerance) with the Cauchy-Born law, reported with the calibrated Mooney-Rivlin law. A loaded lattice that buckles
/// fails and is not compared. Collective over MPI_COMM_WORLD.
struct PrestretchOptions
{
  double length = 40.; ///< of the sheet, in spacings
  double height = 30.; ///< likewise
  double noise = 0.05; ///< initial displacement of the sites, in spacings
  unsigned int cells_x = 8, cells_y = 6, degree = 2;
};

/// Checks the claim. Where the lattice does not relax, or the finite elements with the Cauchy-Born law find no
/// equilibrium, a row fails; an equilibrium that the Mooney-Rivlin law lacks is reported.
output::Results prestretch_claim(const bridge::Subject &subject, const PrestretchOptions &options);

/// Sheet with a cut, between edges held at a homogeneous deformation.
struct CutSheet
{
  lattice::Cutout cutout;
  double size;         ///< R of the hole, or length of the notch [m]
  double length;       ///< of the sheet, before rounding to whole rows [m]
  double height;       ///< likewise [m]
  lattice::Edges held; ///< the other edges are free
  Eigen::Matrix2d F;   ///< of the held edges [-]

  bool is_hole() const { return cutout.hole_radius > 0.; }
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
  std::vector<lattice::SiteValues> fields;
  double residual; ///< largest force on a free site, per sheet thickness [N/m]

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

/// Relaxes the lattice to a largest force on a free site of 1e-8 mu d. @throws std::runtime_error if the lattice does
/// not relax
CutLattice relaxed_lattice(const bridge::Subject &subject, const CutSheet &sheet);

/// Mesh and refinement of the finite element sheet.
struct CutMesh
{
  unsigned int degree = 3;
  unsigned int refinements = 0; ///< of the whole coarse mesh; the cells around a hole are refined once more
  unsigned int cycles = 1;      ///< of refinement where the error seems largest, each followed by an equilibrium
  double fraction = 0.3;        ///< of the cells, in each cycle [-]
};

/// Differences between a lattice and a continuum of the same sheet, all relative [-]. Positive where the lattice
/// has more, if they have a sign. Energy and reaction are compared as theory-comparison.md, eq. (H.12), has them.
struct CutErrors
{
  double displacement = unknown; ///< rms over the sites with all their bonds, over |F - I| times the size of the cut
  double displacement_all =
    unknown; ///< rms over all free sites: at a rim, one that few bonds hold is far off by itself
  double displacement_max = unknown; ///< largest of all
  double stress = unknown; ///< first Piola, rms over the sites with all their bonds, over the rms of the continuum's
  double cauchy_stress = unknown; ///< likewise
  double stress_scale = unknown;  ///< of all these stresses at once: sum P_lattice : P / sum P : P - 1
  double energy = unknown;        ///< total
  double reaction =
    unknown; ///< force on the right edge along x and on the top edge along y, as a vector, along the continuum's
  double reaction_vector = unknown; ///< length of the difference of both
  double shape = unknown; ///< opening of the hole along x and y, or of the mouth of the notch, likewise as a vector
  double fem = unknown;   ///< change of the displacement in the last cycle, as `displacement`
  double unknowns = unknown;
};

/// Equilibrium of the continuum at the sites of a lattice, in their order.
struct CutSolution
{
  CutErrors errors;               ///< against the lattice
  std::vector<Eigen::Vector2d> u; ///< displacement [m]
  std::vector<Eigen::Matrix2d> P; ///< first Piola stress [Pa]
  Eigen::Vector2d opening;        ///< of the cut [m], as in CutErrors::shape
};

/// Returns the differences between two continua, >= 0, in displacement, stress, scale of stresses, energy, reaction and
/// shape. @param a, b whose errors are against `lattice`
CutErrors distance(const CutLattice &lattice, const CutSolution &a, const CutSolution &b);

/// Calls `compute`. @return why there is no equilibrium, the message of a solver; empty if there is one
std::string no_equilibrium(const std::function<void()> &compute);

/// Solves the finite element sheet of a law and compares it with a lattice; none without an equilibrium, with the
/// reason in `failure`. Collective.
std::optional<CutSolution> compare(const CutLattice &lattice, const bridge::EquivalentSheet &domain,
                                   const continuum::Constitution &law, const CutMesh &mesh, std::string &failure);

/// Sheets with a hole or a notch that the claim `prestretch` compares, and parameters of the comparison.
struct CutStudy
{
  std::string name; ///< "hole" or "notch", also of the table
  /// The sheet for a size of the cut [m] and F of the held edges.
  std::function<CutSheet(const bridge::Subject &, double size, const Eigen::Matrix2d &F)> sheet;
  std::vector<Eigen::Matrix2d> states = {}; ///< F of the held edges, not I; several biaxial ones
  std::vector<double> sizes = {};           ///< R/d or length/d of the local law, ascending, at least four
  std::vector<double> other_sizes = {};     ///< those of them at which the other laws are solved
  CutMesh mesh = {};
  /// Largest sizes whose errors are judged together, in the geometric mean, by what the smaller ones let one expect.
  std::size_t n_judged = 1;
  /// Fault that a test introduces into a lattice before the comparison; none otherwise.
  std::function<void(CutLattice &)> spoil = [](CutLattice &) {};
};

/// Sheets with a round hole.
CutStudy hole_study(bool quick);
/// Sheets with a round hole of a lattice of nearest neighbours, in one state and with more radii: the errors scatter
/// more from one radius to the next.
CutStudy nearest_hole_study(bool quick);
/// Sheets with a notch from a free edge, for both sets of shells.
CutStudy notch_study(bool quick);

/// Comparison of a law with a lattice.
struct CutResult
{
  double size; ///< over d [-]
  std::string law;
  std::optional<CutErrors> errors;      ///< none: no equilibrium was found
  std::string failure;                  ///< why
  double residual;                      ///< of the lattice, over mu d [-]
  std::optional<CutErrors> from_local;  ///< from the local law at the same size
  std::optional<CutErrors> from_middle; ///< of "network": from the mean of "local" and "local-turned"
};

/// All comparisons in one state, laws in the order in which tables have them: "local", "local-moved" (the same at the
/// largest size, the rim or tip moved by what its place is known to, twice), "local-turned" (likewise, the lattice
/// turned by 30 degrees, theory-comparison.md, eq. (H.17)), "network" and "network-gradient" (at the largest size and
/// those of `other_sizes`), "lattice", "isotropic". Collective.
/// @throws std::runtime_error if a lattice does not relax
std::vector<CutResult> compare_sizes(const bridge::Subject &subject, const CutStudy &study, const Eigen::Matrix2d &F);

/// The part of the claim `prestretch` on inhomogeneous fields: rows for each state, and a table named after
/// the study with a row for each size and law (reference-files.md). Rows fail where a lattice does not relax, or a
/// judged law has no equilibrium. Collective.
ClaimOutcome cut_claim(const bridge::Subject &subject, const CutStudy &study);

} // namespace latcon::claims
