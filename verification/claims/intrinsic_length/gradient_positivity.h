#pragma once

#include <optional>

#include "continuum/gradient_law.h"
#include "lattice/material.h"

namespace latcon::claims
{

/// Smallest eigenvalue of the gradient energy at F over all gradients G_iJK of unit size, |G| = 1, symmetric in J and K
/// [Pa m^2]. The energy is positive if it is not negative.
double smallest_eigenvalue(const continuum::GradientLaw &law, const Eigen::Matrix2d &F);

/// Smallest eigenvalue of the lattice's gradient energy with another length, from sums over its bonds
/// (theory-continuum.md, eq. (C.22)). @param length l_d [m]
double smallest_lattice_eigenvalue(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                   const Eigen::Matrix2d &F, double length);

/// Length l_d [m] below which the lattice's gradient energy at F is no longer positive, exactly: largest eigenvalue of
/// the generalised problem of its two parts. None if bonds in compression leave no length with a positive energy;
/// not-a-number if the bonds have no finite stiffness.
std::optional<double> critical_length(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                      const Eigen::Matrix2d &F);

} // namespace latcon::claims
