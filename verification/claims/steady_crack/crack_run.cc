#include "verification/claims/steady_crack/steady_crack_claim.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "lattice/relaxation.h"
#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/fits.h"
#include "support/largest_error.h"
#include "verification/claims/bonds.h"

namespace latcon::claims
{
namespace
{

// Arbitrary: results are dimensionless.
constexpr double spacing = 1e-3, density = 1e3, modulus = 1e6, area_factor = 2. / 3.;

// In spacings: cut along the middle before the strip comes to rest; cut further at the start, to free a trapped crack;
// up to here only bonds across the middle may break, since a crack that starts overshoots.
constexpr double seed = 40., kick = 4., guided = 80.;

class Run
{
public:
  explicit Run(const CrackRunOptions &options)
    : options_(options), // one row more than the strip has, since the lattice has an odd number of them; it is held too
      sheet_(spacing, options.length * spacing,
             static_cast<double>(options.strip.layers() + 1) * (std::sqrt(3.) / 2. * spacing),
             lattice::Orientation::rows_along_crack),
      material_{density, {lattice::LinearBond{modulus}, area_factor, 0.}, {}}
  {
    const double mass = lattice::site_mass(material_, sheet_);
    const double section = lattice::cross_section(material_.nearest, sheet_);
    const double stiffness = section * modulus / spacing, elongation = options.breaking_strain * spacing;
    material_.nearest.viscosity = options.strip.viscosity * std::sqrt(stiffness * mass) * spacing / section;
    time_ = std::sqrt(mass / stiffness);
    force_ = stiffness * elongation;
    energy_ = 0.5 * stiffness * elongation * elongation;
  }

  CrackRun measure()
  {
    const Eigen::Matrix2d F = deformation();
    const double h = options_.time_step * time_;
    if (!(h <= lattice::time_step_limits(sheet_, material_, 1.).combined))
      throw std::invalid_argument("the time step of a crack run is beyond the stable one");
    lattice::Simulation simulation(sheet_, material_, seeded_strip(F), h,
                                   lattice::Fracture(sheet_, material_, 1. + options_.breaking_strain,
                                                     lattice::Toughening{lattice::unbreakable}, F));

    CrackRun run{};
    support::Extremes elsewhere;
    std::vector<double> times, positions; // of the tip
    std::optional<lattice::EnergyBalance> begin;
    std::optional<std::size_t> tip;
    const double patience = 200. * time_; // without a broken bond
    double last_break = 0.;
    for (double X = 0.; X < options_.window_end;)
    {
      const std::vector<lattice::BrokenBond> &broken = simulation.step();
      const double t = simulation.state().time;
      if (begin)
        elsewhere.add(largest_elsewhere(simulation.state(), *tip));
      if (broken.empty())
      {
        if (t - last_break > patience)
          throw std::runtime_error("the crack stopped");
        continue;
      }
      last_break = t;
      for (const lattice::BrokenBond &bond : broken)
        if (!crosses_crack(bond.near, bond.kind))
          ++run.off_line;
      if (begin)
        run.bonds_broken += broken.size();
      if (simulation.tip() == tip)
        continue;
      tip = simulation.tip();
      X = sheet_.reference(*tip).x() / spacing;
      if (X < options_.window_begin)
        continue;
      if (!begin)
        begin = simulation.energies();
      times.push_back(t / time_);
      positions.push_back(X);
    }
    const lattice::EnergyBalance end = simulation.energies();
    const auto per_bond = [&](double difference)
    { return difference / (static_cast<double>(run.bonds_broken) * energy_); };
    run.largest_elsewhere = elsewhere.largest();
    run.speed = support::slope(times, positions);
    run.broken = per_bond(end.broken - begin->broken);
    run.viscous = per_bond(end.viscous - begin->viscous);
    run.released = per_bond(begin->elastic - end.elastic);
    return run;
  }

private:
  std::size_t row_below_crack() const { return options_.strip.free_rows + 1; }
  bool crosses_crack(std::size_t place, std::size_t kind) const
  {
    return sheet_.row_of(place) == row_below_crack() && kind != 0;
  }
  double midpoint(std::size_t place, std::size_t kind) const // along the crack, in spacings
  {
    return (sheet_.reference(place) + 0.5 * sheet_.bond_vector(kind)).x() / spacing;
  }

  // The strip is elongated across the crack alone, so much that bonds across it have the elongation of the driving.
  Eigen::Matrix2d deformation() const
  {
    const double strain =
      options_.driving * options_.breaking_strain / std::sqrt(static_cast<double>(options_.strip.layers()));
    return Eigen::Vector2d(1., std::sqrt((4. * (1. + strain) * (1. + strain) - 1.) / 3.)).asDiagonal();
  }

  lattice::State seeded_strip(const Eigen::Matrix2d &F) const
  {
    lattice::State state = lattice::homogeneous_state(sheet_, material_, F, {false, true, true, true});
    for (std::size_t column = 0; column < sheet_.sites_in_row(1); ++column)
    {
      state.held[sheet_.index(1, column)] = 1;
      state.inverse_mass[sheet_.index(1, column)] = 0.;
    }
    cut(state, seed);
    constexpr double at_rest = 1e-4;
    lattice::relax(state, sheet_, material_, at_rest * force_);
    cut(state, seed + kick);
    for (const lattice::Bond &bond : bonds(state, sheet_))
      if (!crosses_crack(bond.near, bond.kind) && midpoint(bond.near, bond.kind) < guided)
        state.bonds.toughen(bond.near, bond.kind);
    return state;
  }

  void cut(lattice::State &state, double length) const
  {
    for (const lattice::Bond &bond : bonds(state, sheet_))
      if (crosses_crack(bond.near, bond.kind) && midpoint(bond.near, bond.kind) < length)
        state.bonds.remove(bond.near, bond.kind);
  }

  // Largest elongation near the tip of bonds that do not cross the crack, over the breaking one.
  double largest_elsewhere(const lattice::State &state, std::size_t tip) const
  {
    const std::size_t reach = std::min<std::size_t>(4, options_.strip.free_rows), column_of_tip = sheet_.column_of(tip);
    support::Extremes elongations;
    for (std::size_t row = row_below_crack() - reach; row <= row_below_crack() + reach; ++row)
      for (std::size_t column = column_of_tip - 2 * reach; column <= column_of_tip + 2 * reach; ++column)
        for (std::size_t kind = 0; kind < lattice::n_kinds_per_shell; ++kind)
        {
          const std::size_t place = sheet_.index(row, column);
          if (!crosses_crack(place, kind) && state.bonds.present(place, kind))
            elongations.add(lattice::stretch(state, sheet_, sheet_.bond(place, kind)) - 1.);
        }
    return elongations.largest() / options_.breaking_strain;
  }

  const CrackRunOptions &options_;
  lattice::TriangularLattice sheet_;
  lattice::Material material_;
  double time_;   // sqrt(m/k) [s]
  double force_;  // k e_c, per sheet thickness [N/m]
  double energy_; // k e_c^2 / 2, per sheet thickness [J/m]
};

} // namespace

CrackRun run_crack(const CrackRunOptions &options)
{
  return Run(options).measure();
}

} // namespace latcon::claims
