#pragma once

#include "continuum/damage/fibre_forces.h"

namespace latcon::continuum
{
/// Mass of a sheet in motion with damage and micro-inertia (theory-damage.md, eqs. (C.78) to (C.80)):
///   v.M v = sum over nodes of m_a |v_a|^2 + rho l_d^2 sum over cells of g_c integral of |Grad v|^2,
/// with lumped masses m_a (C.69) and bilinear v. Held components are at rest.
///
/// The inverse is a fixed number of Chebyshev iterations with known bounds of the spectrum, which hold for every
/// damage: one fixed symmetric matrix, without scalar products, so that bits do not depend on the numbers of ranks,
/// which share the rows of nodes, and of threads.
class MassOperator
{
public:
  /// Creates the operator of an undamaged sheet. `held` marks components at rest; `length` l_d [m] >= 0; 0: lumped
  /// masses alone, divided by directly.
  MassOperator(const NodeGrid &grid, double density, double length, const std::array<std::vector<char>, 2> &held,
               MPI_Comm communicator = MPI_COMM_SELF);

  /// Sets the factors g_c of the cells [-].
  void update(const std::vector<double> &factors);

  /// Computes M v [kg/(m s)], also at held components, where v is to be zero.
  void multiply(const std::vector<double> &v, std::vector<double> &result) const;

  /// Replaces forces by accelerations, zero where held. Collective.
  void solve(GridVector &forces) const;

  /// Returns v.M v / 2 [J/m].
  double kinetic_energy(const GridVector &v) const;

  const std::vector<double> &lumped() const { return lumped_; } ///< m_a [kg/m]
  unsigned int n_iterations() const { return n_iterations_; }   ///< of solve()

  /// Error of solve() in the norm of M over that of the solution, at most [-].
  static constexpr double tolerance = 1e-7;

private:
  void multiply_rows(std::size_t begin, std::size_t end, const std::vector<double> &v,
                     std::vector<double> &result) const;

  NodeGrid grid_;
  RowBands bands_;
  double density_, length_;
  std::array<std::vector<char>, 2> held_;
  std::vector<double> lumped_;
  // Entries of l_d^2 rho times the Laplacian: of a node with itself and with its neighbours to the right, above, above
  // to the right and above to the left.
  std::vector<double> centre_, right_, above_, above_right_, above_left_;
  std::array<std::vector<double>, 2> inverse_; // of the lumped masses, 0 where held
  double largest_;                             // bound of the eigenvalues of M over the lumped masses
  unsigned int n_iterations_ = 0;
};
} // namespace latcon::continuum
