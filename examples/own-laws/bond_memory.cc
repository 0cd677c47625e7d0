// Experiment: a lattice whose bonds remember, with one variable per bond, held stretched and made to ring.
//
// Parallel to a neo-Hookean rod, each bond has a spring in series with a dashpot whose rate grows with the square of
// its stress: it relaxes fast at first and ever more slowly. A sheet is stretched at once and held; its stored energy
// is compared with the closed form. Then it rings, and the energy balance is computed. Exit code 1 if one disagrees.
#include <cmath>
#include <cstdio>
#include <memory>

#include "lattice/energy.h"
#include "lattice/simulation.h"
#include "lattice/time_step.h"

using namespace latcon;

namespace
{

/// Spring E in series with a dashpot of rate q |q| / (E Y tau); the variable of a bond is its overstress q [Pa]:
///   q' = E lam' - q |q| / (Y tau)
class QuadraticBranch : public lattice::CustomMemoryLaw
{
public:
  /// E [Pa], and the product Y tau [Pa s] as above.
  QuadraticBranch(double E, double Y_tau) : E_(E), Y_tau_(Y_tau) {}

  std::size_t n_variables() const noexcept override { return 1; }

  // Relaxation at constant stretch for half the time, the change of stretch at once, and relaxation again: of second
  // order, and exact where the bond is held.
  double advance(double duration, double before, double now, double *q) const noexcept override
  {
    *q = relaxed(relaxed(*q, 0.5 * duration) + E_ * (now - before), 0.5 * duration);
    return *q;
  }

  double stored_energy(double, const double *q) const noexcept override { return 0.5 * *q * *q / E_; }

  double dissipation(double, const double *q) const noexcept override { return std::abs(*q) * *q * *q / (E_ * Y_tau_); }

  double largest_stiffness() const noexcept override { return E_; }

  /// Overstress after `duration` [s] at constant stretch.
  double relaxed(double q, double duration) const { return q / (1. + std::abs(q) * duration / Y_tau_); }

private:
  double E_, Y_tau_;
};

bool agrees(const char *what, const char *unit, double measured, double theory, double scale, double tolerance)
{
  const double error = std::abs(measured - theory) / scale;
  std::printf("%-38s %14.8g %14.8g %-5s off by %.1e of %.1e\n", what, measured, theory, unit, error, tolerance);
  return error <= tolerance; // not so for NaN
}

} // namespace

int main()
{
  // A square sheet of nearest neighbours, held at its edges.
  const double d = 1e-3, E = 2e5, Y_tau = 2.;
  const auto law = std::make_shared<QuadraticBranch>(E, Y_tau);
  const lattice::Shell shell{lattice::MooneyRivlinBond(1e5, 0.), 2. / 3., 10., lattice::CustomMemory(law)};
  const lattice::Material material{944., shell, std::nullopt};
  const lattice::TriangularLattice sheet(d, 16. * d, 16. * d, lattice::Orientation::rows_along_crack);
  const double h = 0.2 * lattice::time_step_limits(sheet, material, 0.5).combined;
  bool good = true;

  std::printf("%-38s %14s %14s\n", "quadratic dashpots in series", "lattice", "closed form");

  // Stretched equally both ways by 1.5 at once: every bond remembers rest, and has the overstress E (lam - 1).
  const double stretch = 1.5;
  lattice::State state = homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), lattice::Edges::held);
  relax_memory(state, sheet, material);
  const lattice::State loaded =
    homogeneous_state(sheet, material, stretch * Eigen::Matrix2d::Identity(), lattice::Edges::held);
  state.position = loaded.position;
  std::size_t bonds = 0;
  for_each_bond(state, sheet, [&](const lattice::Bond &) { ++bonds; });
  lattice::Simulation held(sheet, material, std::move(state), h);
  const double volume = static_cast<double>(bonds) * cross_section(shell, sheet) * d;
  const double at_first = volume * 0.5 * E * std::pow(stretch - 1., 2);
  for (const int steps : {0, 50, 500})
  {
    for (int step = 0; step < steps; ++step)
      held.step();
    const double q = law->relaxed(E * (stretch - 1.), held.state().time), stored = volume * 0.5 * q * q / E;
    std::printf("after %.3g s\n", held.state().time);
    // One rounding per step.
    good &= agrees("  energy stored in the bonds' memory", "J/m", memory_energy(held.state(), sheet, material), stored,
                   at_first, 1e-12);
  }

  // A shear wave at this stretch, damped by both dashpots: what left the motion is in the ledger, up to the square of
  // the step.
  double imbalance[2];
  for (const int finer : {1, 2})
  {
    lattice::Simulation ringing(sheet, material, loaded, h / finer);
    lattice::VectorField velocity(sheet.n_places());
    for (std::size_t i = 0; i < sheet.n_places(); ++i)
      velocity.y[i] = 5. * std::sin(6. * sheet.reference(i).x() / sheet.length());
    ringing.set_velocities(velocity);
    const double kinetic = ringing.energies().kinetic;
    for (int step = 0; step < 400 * finer; ++step)
      ringing.step();
    const lattice::EnergyBalance e = ringing.energies();
    imbalance[finer - 1] = std::abs(e.imbalance());
    good &= agrees("  imbalance of the energies, ringing", "J/m", e.imbalance(), 0., kinetic, 1e-3 / (finer * finer));
    good &= memory_energy(ringing.state(), sheet, material) > 1e-6 * kinetic;
  }
  good &= agrees("  ratio of the imbalances", "", imbalance[0] / imbalance[1], 4., 4., 0.1);
  std::puts(good ? "all agree" : "they do NOT agree");
  return good ? 0 : 1;
}
