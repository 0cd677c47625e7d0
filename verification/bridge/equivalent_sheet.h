#pragma once

#include "lattice/cutout.h"
#include "lattice/material.h"

namespace latcon::bridge
{

// Where the edges of a lattice sheet are, as a continuum feels them (theory-comparison.md, section "Edges of the
// continuum"). To name them to a whole spacing is to leave an error of first order in d/R, which says nothing about the
// law.

/// delta [m]: a free edge of the continuum lies this far inside the cells of the outermost sites, whose bonds across it
/// are missing; mean over the directions of the edge, at small strain (theory-comparison.md, eq. (H.10)).
double rim_recession(const lattice::TriangularLattice &lattice, const lattice::Material &material);

/// Depth [m] below the outermost sites at which an edge of the continuum is held where the lattice has its layer of
/// held sites; mean over displacements across and along the edge, at small strain (theory-comparison.md, eq. (H.11)).
/// @param normal unit vector along x or y
double held_depth(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                  const Eigen::Vector2d &normal);

/// How far the cells of the outermost sites reach beyond those sites at an edge, on average [m]: half a distance of
/// rows, or a quarter of d where every second row is one site shorter.
double cell_overhang(const lattice::TriangularLattice &lattice, const Eigen::Vector2d &normal);

/// The continuum's sheet in the coordinates of the lattice.
struct EquivalentSheet
{
  double left, right, bottom, top; ///< X of the left and right edge, Y of bottom and top [m]
  double cut;                      ///< radius of the hole, or length of the notch from the left edge [m]

  double length() const { return right - left; }
  double height() const { return top - bottom; }
};

/// @param state whose sites have been cut out
/// @param edges which are held, the others being free
EquivalentSheet equivalent_sheet(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                 const lattice::State &state, const lattice::Edges &edges,
                                 const lattice::Cutout &cutout);

/// The sheet as a case describes it: edges through the outermost sites, hole and notch of their nominal size.
EquivalentSheet nominal_sheet(const lattice::TriangularLattice &lattice, const lattice::Cutout &cutout);

} // namespace latcon::bridge
