#include "verification/claims/energy/energy_claim.h"

#include <cmath>

#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/largest_error.h"
#include "verification/bridge/plane_waves.h"
#include "verification/claims/lattice_waves.h"
#include "verification/claims/order_fit.h"
#include "verification/claims/states.h"

namespace latcon::claims
{
namespace
{

constexpr double wave_strain = 1e-3;
const output::Tolerance lattice_energy_tolerance{
  1e-6, "second differences of energies with a strain of 1e-3: its fourth power times higher moduli, round-off of the "
        "energy of the stretched sheet over its square"};
// Travelling waves that are judged.
constexpr double judged_kd = 0.25;

// Energy density that the displacement amplitude * p cos K.X adds, over amplitude^2 [J/m^5], on the lattice.
double lattice_stiffness(const WaveCell &cell, const lattice::Material &material, const Eigen::Matrix2d &F,
                         const Eigen::Vector2d &p)
{
  const lattice::TriangularLattice &sheet = cell.sheet;
  const lattice::State at_rest = lattice::homogeneous_state(sheet, material, F, lattice::Edges::free);
  const auto energy = [&](double amplitude)
  {
    lattice::State state = at_rest;
    add_wave(state, cell, amplitude, p);
    lattice::update_images(state, sheet);
    return lattice::elastic_energy(state, sheet, material);
  };
  const double area = static_cast<double>(sheet.n_sites()) * sheet.site_area();
  return half_second_derivative(energy, wave_strain / cell.K.norm()) / area;
}

// Mean stiffness energy in closed form, (1/4) p.(rho (1 + l^2 k^2) D) p: mean of cos^2 times half the stiffness.
double closed_stiffness(const WaveContinuum &medium, const Eigen::Matrix2d &F, const Eigen::Vector2d &K,
                        const Eigen::Vector2d &p)
{
  const double mass = medium.inertia.density * (1. + std::pow(medium.inertia.length, 2) * K.squaredNorm());
  return 0.25 * mass * p.dot(continuum_matrices(medium, F, K).stiffness * p);
}

void sinusoidal(const bridge::Subject &subject, const Eigen::Matrix2d &F, const WaveEnergyOptions &options,
                ClaimOutcome &outcome)
{
  const SubjectContinua media(subject);
  const lattice::Material material = lattice::without_dashpots(subject.material);
  const double d = subject.spacing, l_d = subject.lengths.lattice;
  output::Table &table = outcome.table("sinusoidal_energy", {"shells", "F_xx", "F_yy", "angle [deg]", "wave", "k d",
                                                             "lattice", "local", "gradient", "filtered", "fem"});
  const lattice::TriangularLattice sheet = subject.sheet();
  support::LargestError lattice_error, element_error, excess_error;
  CommonOrder local_order, gradient_order, filtered_order;
  for (const WaveDirection &direction : {WaveDirection{1, 0}, WaveDirection{1, 2}})
  {
    const Eigen::Vector2d N = unit_vector(direction, subject.orientation);
    for (const double kd : options.kd)
    {
      const WaveCell cell = wave_cell(d, subject.orientation, direction, kd);
      const double inertia = 1. + std::pow(l_d, 2) * cell.K.squaredNorm();
      // One field for all: polarised as the waves of the local continuum.
      const auto waves = continuum_waves(media.local, F, cell.K);
      for (std::size_t w = 0; w < 2; ++w)
      {
        const Eigen::Vector2d &p = waves[w].polarisation;
        const double local = closed_stiffness(media.local, F, cell.K, p),
                     gradient = closed_stiffness(media.gradient, F, cell.K, p),
                     bloch = 0.25 * material.density *
                             p.dot(bridge::bloch_matrices(cell.sheet, material, F, cell.K).stiffness * p),
                     measured = lattice_stiffness(cell, material, F, p),
                     elements =
                       sinusoidal_energy(media.gradient, F, cell.K, p, wave_strain / cell.K.norm(), options.mesh);
        lattice_error.add_relative(measured, bloch);
        element_error.add_relative(elements, gradient);
        table.add({subject.name, F(0, 0), F(1, 1), angle(direction, subject.orientation), wave_names[w],
                   cell.K.norm() * d, measured / local, 1., gradient / local, gradient / inertia / local,
                   elements / local});
      }
    }
    for (std::size_t i = 0; i < order_kd.size(); ++i)
    {
      const Eigen::Vector2d K = order_kd[i] / d * N;
      const double inertia = 1. + l_d * l_d * K.squaredNorm();
      const Eigen::Matrix2d exact = bridge::bloch_matrices(sheet, material, F, K).stiffness,
                            filtered = continuum_matrices(media.gradient, F, K).stiffness;
      local_order.add(i, continuum_matrices(media.local, F, K).stiffness, exact);
      gradient_order.add(i, inertia * filtered, exact);
      filtered_order.add(i, filtered, exact);
      // To leading order the excess is l_d^2 k^2, whatever the wave; what follows is of fourth order.
      if (i == 0)
        excess_error.add_relative((inertia * filtered - exact).norm() / exact.norm(), inertia - 1.);
    }
  }
  const Rows rows(outcome.results, "energy", subject.name + ", sinusoidal field about " + state_name(F) + ": ");
  rows.add("energy of the lattice against Bloch, worst of all fields", "1", {}, lattice_error,
           lattice_energy_tolerance);
  rows.add(
    "energy of the finite elements against their continuum, worst of all fields", "1", {}, element_error,
    {4. * discretisation_bound(options.mesh),
     "bound of the best approximation (Ainsworth), times q(q+1)/(4q-2) < 2 for values at Gauss-Lobatto nodes, and as "
     "much again for the jumps between cells, which these values do not minimise"});
  const bool is_judged = subject.judges_gradient(F);
  const std::string order = "order in kd to which ";
  add_order(rows, order + "local continuum and lattice agree", local_order, 2.);
  add_order(rows, order + "the gradient continuum's unfiltered energy and the lattice's agree: 2 as without gradient",
            gradient_order, 2., is_judged);
  rows.add("excess of the gradient continuum's energy over l_d^2 k^2 at kd = 0.05", "1",
           of_continuum(excess_error.value() / excess_error.reference(), 1.), excess_error,
           {std::pow(order_kd[0], 2), "the next term, (kd)^2 of this one"}, is_judged);
  add_order(rows, order + "the gradient continuum's energy over 1 + l_d^2 k^2 and the lattice's agree", filtered_order,
            4., is_judged);
}

// Of the lattice, in the eighth of a period for which a wave travels.
constexpr double least_steps = 40.;

// A wave amplitude * p cos(K.X - w t) that travels through the lattice for an eighth of a period.
TravellingEnergy travelling_lattice(const WaveCell &cell, const lattice::Material &material, const Eigen::Matrix2d &F,
                                    const bridge::PlaneWave &wave, double amplitude)
{
  const lattice::TriangularLattice &sheet = cell.sheet;
  lattice::State state = lattice::homogeneous_state(sheet, material, F, lattice::Edges::free);
  const double at_rest = lattice::elastic_energy(state, sheet, material);
  add_wave(state, cell, amplitude, wave.polarisation, wave.frequency);
  // The wave itself shortens bonds a little more.
  const double limit = lattice::time_step_limits(sheet, material, 0.99 * smallest_stretch(sheet, F)).combined;
  const double eighth = 0.25 * M_PI / wave.frequency;
  const auto steps = static_cast<int>(std::ceil(eighth / support::smallest_of({0.5 * limit, eighth / least_steps})));
  lattice::Simulation simulation(sheet, material, std::move(state), eighth / steps);
  for (int step = 0; step < steps; ++step)
    simulation.step();
  const lattice::EnergyBalance energies = simulation.energies();
  const double area = static_cast<double>(sheet.n_sites()) * sheet.site_area();
  return {(energies.elastic - at_rest) / area, energies.kinetic / area, 0.};
}

void travelling(const bridge::Subject &subject, const Eigen::Matrix2d &F, double wanted_kd, const WaveMesh &mesh,
                ClaimOutcome &outcome)
{
  const SubjectContinua media(subject);
  const lattice::Material material = lattice::without_dashpots(subject.material);
  const double d = subject.spacing, rho = material.density;
  const WaveCell cell = wave_cell(d, subject.orientation, {1, 0}, wanted_kd);
  // Round-off of the energy of the stretched sheet, up to 1e11 times that of the wave, bounds the strain from below.
  constexpr double travelling_strain = 1e-4;
  const double kd = cell.K.norm() * d, amplitude = travelling_strain / cell.K.norm();
  const double inertia = 1. + std::pow(subject.lengths.lattice / d * kd, 2);
  const auto bloch = bridge::bloch_waves(cell.sheet, material, F, cell.K),
             closed = continuum_waves(media.gradient, F, cell.K);
  // Both sides are followed for an eighth of a period, if the wave has one.
  for (const auto &waves : {bloch, closed})
    static_cast<void>(bridge::fastest_frequency(waves));
  output::Table &table =
    outcome.table("travelling_waves", {"shells", "F_xx", "F_yy", "angle [deg]", "wave", "k d",
                                       "lattice_elastic [J/m^3]", "lattice_kinetic [J/m^3]", "fem_elastic [J/m^3]",
                                       "fem_kinetic [J/m^3]", "fem_micro_inertia [J/m^3]", "theory [J/m^3]"});
  for (std::size_t w = 0; w < 2; ++w)
  {
    const TravellingEnergy run = travelling_lattice(cell, material, F, bloch[w], amplitude);
    const TravellingEnergy elements = travelling_energy(media.gradient, F, cell.K, w, amplitude, mesh);
    const double theory = 0.5 * rho * std::pow(bloch[w].frequency * amplitude, 2),
                 continuum_theory = 0.5 * rho * inertia * std::pow(closed[w].frequency * amplitude, 2);
    const double total = run.elastic + run.kinetic, element_total = elements.elastic + elements.kinetic;
    table.add({subject.name, F(0, 0), F(1, 1), 0., wave_names[w], kd, run.elastic, run.kinetic, elements.elastic,
               elements.kinetic - elements.micro_inertia, elements.micro_inertia, 0.5 * theory});
    if (wanted_kd != judged_kd)
      continue; // for the plot
    const Rows rows(outcome.results, "energy",
                    support::text_of(subject.name, ", travelling ", wave_names[w], " wave about ", state_name(F),
                                     ", kd = ", std::round(1e3 * kd) / 1e3, ": "));
    // Harmonic waves share their energy equally.
    const double of_step = 0.25 * std::pow(0.25 * M_PI / least_steps, 2);
    const output::Tolerance tolerance{
      of_step + 3e-5, "velocity Verlet: (w h)^2 / 4, 40 steps in an eighth of a period; average acceleration conserves "
                      "both energies of a wave; elements in space 3e-5"};
    rows.add("elastic against kinetic energy, lattice and finite elements", "J/m^3",
             of_both(run.elastic, elements.elastic, 0.5 * theory),
             support::largest_of({support::relative_error(run.elastic, run.kinetic),
                                  support::relative_error(elements.elastic, elements.kinetic)}),
             tolerance);
    rows.add("energy, lattice and finite elements each against its theory", "J/m^3",
             of_both(total, element_total, theory),
             support::largest_of(
               {support::relative_error(total, theory), support::relative_error(element_total, continuum_theory)}),
             tolerance);
    // The speeds differ by 1e-4 at most here (claim wave-speeds; more with third-nearest neighbours), energies by twice
    // that and the time stepping.
    rows.add("energy of the finite elements over 1 + l_d^2 k^2, against the lattice", "J/m^3",
             of_both(total, element_total / inertia, theory), support::relative_error(element_total / inertia, total),
             {2e-4 * gradient_remainder(subject) + *tolerance,
              "twice the difference in speed that wave-speeds allows at kd = 0.25; " + tolerance.reason},
             subject.judges_gradient(F));
    const output::Tolerance harmonic_tolerance{
      1.5e-4, "second harmonic, with an amplitude of the strain of 1e-4 times third over second moduli, up to 30: 16 "
              "times its square"};
    const double share = elements.kinetic * (1. - 1. / inertia);
    rows.add("micro-inertia's share of the kinetic energy, l_d^2 k^2 / (1 + l_d^2 k^2)", "J/m^3",
             of_continuum(elements.micro_inertia, share), support::relative_error(elements.micro_inertia, share),
             harmonic_tolerance);
  }
}

} // namespace

ClaimOutcome wave_energy_claim(const bridge::Subject &subject, const WaveEnergyOptions &options)
{
  ClaimOutcome outcome;
  const Rows rows(outcome.results, "energy", subject.name + ", ");
  for (const Eigen::Matrix2d &F : options.states)
    rows.attempt("sinusoidal field about " + state_name(F), [&] { sinusoidal(subject, F, options, outcome); });
  for (const Eigen::Matrix2d &F : options.states)
    for (const double kd : options.kd)
      rows.attempt(support::text_of("travelling waves about ", state_name(F), ", kd = ", kd),
                   [&] { travelling(subject, F, kd, options.travelling_mesh, outcome); });
  return outcome;
}

} // namespace latcon::claims
