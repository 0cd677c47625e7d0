#include "verification/bridge/equivalent_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "support/largest_error.h"

namespace latcon::bridge
{
namespace
{

// Returns the stiffness psi''(1) A0 / l of the bonds of a kind against elongation, per sheet thickness [Pa]; 0 if there
// are none.
double spring_constant(const lattice::TriangularLattice &lattice, const lattice::Material &material, std::size_t kind)
{
  const lattice::Shell *shell = material.shell(kind);
  return shell == nullptr
           ? 0.
           : lattice::stiffness(shell->law, 1.) * lattice::cross_section(*shell, lattice) / lattice.rest_length(kind);
}

// Returns the effective depth at which a chain of planes is held whose planes 0 to reach - 1 are fixed, in units of the
// distance of planes: the zero of the linear far-field displacement. `springs[m]` connects planes m apart.
double chain_depth(const std::vector<double> &springs, std::size_t reach)
{
  // The perturbation by the held planes decays by a factor of three or more per plane, with springs to the fourth plane
  // more slowly.
  const std::size_t n = reach <= 3 ? 60 : 240;
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    const bool held = i < reach, far = i + reach >= n;
    if (held || far)
    {
      K(i, i) = 1.;
      f(i) = far ? static_cast<double>(i) : 0.;
      continue;
    }
    for (std::size_t m = 1; m <= reach; ++m)
      for (const std::size_t j : {i - m, i + m})
      {
        K(i, i) += springs[m];
        K(i, j) -= springs[m];
      }
  }
  const Eigen::VectorXd u = K.partialPivLu().solve(f);
  const double slope = (u(n / 2 + 10) - u(n / 2 - 10)) / 20.;
  return static_cast<double>(n / 2) - u(n / 2) / slope;
}

} // namespace

double rim_recession(const lattice::TriangularLattice &lattice, const lattice::Material &material)
{
  double moment = 0., sum = 0.;
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
  {
    const double l = lattice.rest_length(kind);
    const double weight = spring_constant(lattice, material, kind) * l * l; // A0 l psi''
    moment += weight * l;
    sum += weight;
  }
  return 23. / (45. * M_PI) * moment / sum;
}

double stretched_rim_recession(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                               const double stretch)
{
  // Sum over shells and directions of f(psi and psi' of the bond, its sine to the edge, its stretch, l, A0 l).
  constexpr int n_angles = 180;
  const auto sum = [&](double across, const auto &term)
  {
    double total = 0.;
    for (std::size_t number = 0; number < lattice::n_shells; ++number)
      if (const lattice::Shell *shell = material.in_shell(number))
      {
        const double l = lattice.rest_length(number * lattice::n_kinds_per_shell);
        for (int i = 0; i < n_angles; ++i)
        {
          const double angle = (i + 0.5) * M_PI / n_angles, sine = std::sin(angle);
          const double lam = std::hypot(stretch * std::cos(angle), across * sine);
          total += lattice::cross_section(*shell, lattice) * l * term(shell->law, lam, sine, l);
        }
      }
    return total;
  };
  const auto traction = [&](double across)
  {
    return sum(across, [&](const lattice::BondLaw &law, double lam, double sine, double)
               { return lattice::force(law, lam) * across * sine * sine / lam; });
  };
  // Without traction across the edge.
  double low = 0.1, high = 1.;
  while (high - low > 1e-12)
  {
    const double middle = 0.5 * (low + high);
    (traction(middle) < 0. ? low : high) = middle;
  }
  const auto moment = sum(low, [](const lattice::BondLaw &law, double lam, double sine, double l)
                          { return (lattice::energy(law, lam) - lattice::energy(law, 1.)) * 0.5 * sine * l; });
  return moment / sum(low, [](const lattice::BondLaw &law, double lam, double, double)
                      { return lattice::energy(law, lam) - lattice::energy(law, 1.); });
}

double held_depth(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                  const Eigen::Vector2d &normal)
{
  const double d = lattice.spacing();
  support::Extremes pitches;
  pitches.add(d);
  std::array<double, lattice::n_bond_kinds> across{};
  for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
  {
    across[kind] = std::abs(lattice.bond_vector(kind).dot(normal));
    if (across[kind] > 0.1 * d)
      pitches.add(across[kind]);
  }
  const double pitch = pitches.smallest();
  std::size_t reach = 0;
  std::array<std::vector<double>, 2> springs;
  for (const bool along : {false, true})
  {
    springs[along].assign(5, 0.); // bonds of 2 d span four planes half a spacing apart
    for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    {
      const double k = spring_constant(lattice, material, kind);
      const auto planes = static_cast<std::size_t>(std::lround(across[kind] / pitch));
      if (k == 0. || planes == 0)
        continue;
      const double cosine = across[kind] / lattice.rest_length(kind);
      springs[along][planes] += k * (along ? 1. - cosine * cosine : cosine * cosine);
      reach = std::max<std::size_t>(reach, planes);
    }
  }
  return 0.5 * pitch * (chain_depth(springs[0], reach) + chain_depth(springs[1], reach));
}

double cell_overhang(const lattice::TriangularLattice &lattice, const Eigen::Vector2d &normal)
{
  const bool along_rows =
    (std::abs(normal.x()) > 0.5) == (lattice.orientation() == lattice::Orientation::rows_along_crack);
  return lattice.spacing() * (along_rows ? 0.25 : std::sqrt(3.) / 4.);
}

EquivalentSheet equivalent_sheet(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                                 const lattice::State &state, const lattice::Edges &edges,
                                 const lattice::Cutout &cutout)
{
  const Eigen::Vector2d x(1., 0.), y(0., 1.);
  const double recession = rim_recession(lattice, material);
  const auto depth = [&](bool held, const Eigen::Vector2d &normal)
  { return held ? held_depth(lattice, material, normal) : recession - cell_overhang(lattice, normal); };
  EquivalentSheet sheet{depth(edges.left, x), lattice.length() - depth(edges.right, x),
                        -0.5 * lattice.height() + depth(edges.bottom, y), 0.5 * lattice.height() - depth(edges.top, y),
                        0.};
  std::size_t removed = 0;
  support::Extremes X; // of the sites removed by a notch
  X.add(0.);
  for (std::size_t place = 0; place < lattice.n_places(); ++place)
    if (lattice.is_site(place) && state.removed[place] != 0)
    {
      ++removed;
      X.add(lattice.reference(place).x());
    }
  if (cutout.hole_radius > 0.)
    sheet.cut = std::sqrt(static_cast<double>(removed) * lattice.site_area() / M_PI) + recession;
  else
    // The cell of the last site ends half way to the next site on the line.
    sheet.cut =
      X.largest() - sheet.left +
      (lattice.orientation() == lattice::Orientation::rows_along_crack ? 0.5 : 0.5 * std::sqrt(3.)) * lattice.spacing();
  return sheet;
}

} // namespace latcon::bridge
