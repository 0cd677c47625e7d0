// Experiment: a lattice whose bonds stiffen as their chains come to full length, pulled and made to ring.
//
// The bonds follow Gent's law of rubber, A. N. Gent, Rubber Chem. Technol. 69, 59 (1996). A sheet of them is stretched
// equally both ways. Measured are the energy and its slope, and the speed of a shear wave; each is set beside the
// closed form for the continuum that the lattice approximates. Exit code 1 if one disagrees.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "lattice/energy.h"
#include "lattice/simulation.h"
#include "lattice/time_step.h"

using namespace latcon;

namespace
{

const double pi = std::acos(-1.);

/// Uniaxial incompressible Gent rod, with I1 = lam^2 + 2 / lam:
///   psi = -(mu Jm / 2) ln(1 - (I1 - 3) / Jm)
/// The chains lock at I1 - 3 = Jm.
class GentRod : public lattice::CustomBondLaw
{
public:
  /// mu [Pa] and Jm [-] as above; `longest` [-] is the largest stretch that a bond is to have.
  GentRod(double mu, double Jm, double longest) : mu_(mu), Jm_(Jm), longest_(longest) {}

  double energy(double stretch) const noexcept override { return -0.5 * mu_ * Jm_ * std::log(slack(stretch)); }

  double force(double stretch) const noexcept override { return mu_ * neo_hookean(stretch) / slack(stretch); }

  double stiffness(double stretch) const noexcept override
  {
    const double s = slack(stretch), f = neo_hookean(stretch);
    return mu_ * ((1. + 2. / std::pow(stretch, 3)) / s + 2. * f * f / (Jm_ * s * s));
  }

  // Stiff when it is short and when it is long, and softest in between; psi' / lam is always less.
  double largest_stiffness(double smallest_stretch) const noexcept override
  {
    return std::max(stiffness(smallest_stretch), stiffness(longest_));
  }

private:
  static double neo_hookean(double stretch) { return stretch - 1. / (stretch * stretch); }

  /// Remaining length of the chains: 1 at rest, 0 where they lock, NaN beyond.
  double slack(double stretch) const
  {
    const double left = 1. - (stretch * stretch + 2. / stretch - 3.) / Jm_;
    return left > 0. ? left : std::numeric_limits<double>::quiet_NaN();
  }

  double mu_, Jm_, longest_;
};

bool agrees(const char *what, const char *unit, double measured, double theory, double tolerance)
{
  const double error = std::abs(measured / theory - 1.);
  std::printf("%-34s %12.6g %12.6g %-6s  off by %.1e of %.1e\n", what, measured, theory, unit, error, tolerance);
  return error <= tolerance; // not so for NaN
}

} // namespace

int main()
{
  // The sheet: nearest neighbours, no dashpots, without end in both directions.
  const auto law = std::make_shared<GentRod>(8e4, 30., 3.);
  const double d = 1e-3, density = 944., area_factor = 2. / 3.;
  const lattice::Material material{density, {lattice::CustomBond(law), area_factor, 0.}, std::nullopt};
  const lattice::TriangularLattice sheet(d, 48. * d, 8. * d, lattice::Orientation::rows_along_crack, {true, true});
  const double area = static_cast<double>(sheet.n_sites()) * sheet.site_area();
  const auto stretched = [&](double stretch)
  {
    const Eigen::Matrix2d F = stretch * Eigen::Matrix2d::Identity();
    return lattice::homogeneous_state(sheet, material, F, lattice::Edges::free);
  };
  const auto energy = [&](double stretch) { return elastic_energy(stretched(stretch), sheet, material) / area; };

  std::printf("%-34s %12s %12s\n", "Gent bonds, stretched both ways", "lattice", "closed form");
  bool good = true;

  // Each of three families of bonds has the volume s of the sheet's (theory.md, eq. (L.4)), and all have its stretch.
  for (const double stretch : {1.5, 2.5})
  {
    std::printf("stretch %.1f\n", stretch);
    good &= agrees("  energy density", "J/m^3", energy(stretch), 3. * area_factor * law->energy(stretch), 1e-12);
    // A difference quotient of step e is off by e^2 and by the round-off over e.
    const double e = 1e-5;
    const double slope = (energy(stretch + e) - energy(stretch - e)) / (2. * e);
    good &= agrees("  its slope with the stretch", "Pa", slope, 3. * area_factor * law->force(stretch), 1e-8);

    // A standing shear wave u_y = a cos(omega t) sin(K X), let go at rest: a vanishes after a quarter of its period.
    const double K = 2. * pi / sheet.length(), amplitude = 1e-4 * d;
    lattice::State state = stretched(stretch);
    const auto for_each_site = [&](const auto &visit)
    {
      for (std::size_t row = 0; row < sheet.rows(); ++row)
        for (std::size_t column = 0; column < sheet.sites_in_row(row); ++column)
          visit(sheet.index(row, column));
    };
    for_each_site([&](std::size_t i) { state.position.y[i] += amplitude * std::sin(K * sheet.reference(i).x()); });
    update_images(state, sheet);
    const double h = 0.2 * lattice::time_step_limits(sheet, material, 1.).combined;
    lattice::Simulation simulation(sheet, material, std::move(state), h);
    double before = amplitude, now = amplitude;
    for (int step = 0; step < 10000 && now > 0.; ++step)
    {
      simulation.step();
      before = now;
      now = 0.;
      for_each_site(
        [&](std::size_t i)
        {
          const Eigen::Vector2d X = sheet.reference(i);
          now += 2. / static_cast<double>(sheet.n_sites()) * (simulation.state().position.y[i] - stretch * X.y()) *
                 std::sin(K * X.x());
        });
    }
    const double quarter = simulation.state().time - h * now / (now - before);
    const double omega = pi / 2. / quarter;

    // Shear across bonds at 0, 60 and 120 degrees n to the wave: rho c^2 = s sum n_x^2 (n_y^2 psi'' + n_x^2 psi'/lam).
    // The lattice is slower by at most (K d)^2 / 24, Verlet's steps make it faster by (omega h)^2 / 24.
    const double stiffness = law->stiffness(stretch), tension = law->force(stretch) / stretch;
    const double theory = std::sqrt(area_factor * (3. / 8. * stiffness + 9. / 8. * tension) / density);
    const double tolerance = (std::pow(K * d, 2) + std::pow(omega * h, 2)) / 24.;
    good &= agrees("  speed of a shear wave", "m/s", omega / K, theory, tolerance);
  }
  std::puts(good ? "all agree" : "they do NOT agree");
  return good ? 0 : 1;
}
