#pragma once

#include "lattice/cutout.h"
#include "lattice/material.h"

namespace latcon::bridge
{

// Positions of the edges of the continuum that is equivalent to a lattice sheet (theory-comparison.md, section "Edges
// of the continuum"). Positions to within a spacing would leave an error of first order in d/R that is unrelated to the
// law.

/// Returns the distance delta [m] of a free edge of the continuum inside the cells of the outermost sites, which lack
/// bonds across the edge: mean over the directions of the edge, at small strain (theory-comparison.md, eq. (H.10)).
double rim_recession(const lattice::TriangularLattice &lattice, const lattice::Material &material);

/// Returns the same distance [m] for an edge that is stretched by a finite amount along itself and free to contract:
/// mean over the directions of the edge of half the bonds' reach across it, weighted by their energies.
/// @param stretch along the edge [-], > 1
double stretched_rim_recession(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                               double stretch);

/// Returns the depth [m] below the outermost sites of a held edge of the continuum that is equivalent to the layer of
/// held sites of the lattice: mean over displacements across and along the edge, at small strain (theory-comparison.md,
/// eq. (H.11)).
/// @param normal unit vector along x or y
double held_depth(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                  const Eigen::Vector2d &normal);

/// Returns the mean distance by which the cells of the outermost sites extend beyond these sites at an edge [m]: half
/// the distance of rows, or d/4 if every second row is one site shorter.
double cell_overhang(const lattice::TriangularLattice &lattice, const Eigen::Vector2d &normal);

/// Sheet of the continuum in the coordinates of the lattice.
struct EquivalentSheet
{
  double left, right, bottom, top; ///< X of the left and right edge, Y of bottom and top [m]
  double cut;                      ///< radius of the hole, or length of the notch from the left edge [m]

  double length() const { return right - left; }
  double height() const { return top - bottom; }
};

/// Returns the sheet of the continuum that is equivalent to a lattice sheet. @param state lattice sheet with its cutout
/// @param edges held edges; the others are free
EquivalentSheet equivalent_sheet(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                 const lattice::State &state, const lattice::Edges &edges,
                                 const lattice::Cutout &cutout);

} // namespace latcon::bridge
