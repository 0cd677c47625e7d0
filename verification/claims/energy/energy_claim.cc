#include "verification/claims/energy/energy_claim.h"

#include <cmath>

#include "continuum/errors.h"
#include "lattice/simulation.h"
#include "support/largest_error.h"
#include "verification/bridge/homogeneous_response.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/states.h"

namespace latcon::claims
{
namespace
{

const output::Tolerance equal_formulas{bridge::NetworkComparison::equal_formulas,
                                       "a few hundred round-offs of the largest term of sums over about ten bonds, the "
                                       "smallest W being 1e-2 of the moduli"};

// Moduli [Pa] and long-wave speeds [m/s] at F = I.
struct Moduli
{
  double mu, lambda, shear_speed, longitudinal_speed;

  Moduli(double shear, double first_lame, double density)
    : mu(shear), lambda(first_lame), shear_speed(std::sqrt(mu / density)),
      longitudinal_speed(std::sqrt((lambda + 2. * mu) / density))
  {
  }
};

Moduli continuum_moduli(const bridge::Subject &subject, const continuum::Material &law)
{
  const auto tangent = law.tangent(bridge::to_continuum(Eigen::Matrix2d::Identity()));
  return {tangent[0][1][0][1], tangent[0][0][1][1], subject.material.density};
}

// Moduli and speeds on the lattice, in a law of the continuum, and in closed form.
void moduli_rows(const bridge::Subject &subject, const Moduli &lattice_side, bridge::Law law,
                 const std::string &law_name, const Moduli &law_side, const Rows &rows)
{
  const auto add =
    [&](const std::string &quantity, const std::string &unit, double Moduli::*value, double theory, bool is_judged)
  {
    const double on_lattice = lattice_side.*value, on_continuum = law_side.*value;
    const double error =
      support::largest_of({support::relative_error(on_lattice, theory), support::relative_error(on_continuum, theory)});
    rows.add(quantity, unit, of_both(on_lattice, on_continuum, theory), error, small_strain_tolerance, is_judged);
  };
  const bridge::SmallStrain &theory = subject.theory;
  const std::string where = " at F = I, " + law_name;
  const bool is_judged = subject.judges(law);
  add("mu" + where, "Pa", &Moduli::mu, theory.shear_modulus, is_judged);
  add("lambda" + where, "Pa", &Moduli::lambda, theory.shear_modulus, is_judged);
  add("c_S" + where, "m/s", &Moduli::shear_speed, theory.shear_speed, is_judged);
  add("c_L" + where, "m/s", &Moduli::longitudinal_speed, theory.longitudinal_speed, is_judged);
  // Both sides take the cross-section of a bond from the lattice; this row does not.
  if (law == bridge::Law::cauchy_born)
    add("mu at F = I, lattice and Cauchy-Born against a, b and s alone", "Pa", &Moduli::mu,
        absolute_shear_modulus(subject.material), true);
}

// Residual about the calibrated ratio. The smallest residual has no slope, and a wrong ratio has better neighbours. At
// an end of the search interval the residual may fall outwards; only an inward slope is an error.
struct Optimum
{
  double slope; // error, per unit of the ratio
  bool is_end;
};

Optimum optimum(const bridge::Subject &subject, const lattice::TriangularLattice &sheet)
{
  const double ratio = subject.mooney_rivlin->ratio;
  constexpr double step = 1e-4, none = std::numeric_limits<double>::infinity();
  const auto residual = [&](double r)
  {
    try
    {
      return std::abs(r) > bridge::largest_ratio
               ? none
               : bridge::with_ratio(sheet, subject.material, subject.deformation, r).energy_residual;
    }
    catch (const continuum::NonPhysicalState &)
    {
      return none;
    }
  };
  const double below = residual(ratio - step), above = residual(ratio + step);
  if (below < none && above < none)
    return {std::abs(above - below) / (2. * step), false};
  return {support::one_sided((residual(ratio) - (below < above ? below : above)) / step), true};
}

// The law fitted along the loading path. At finite strain the residual of the fit is reported; but the law must be the
// best one, and elliptic, so that finite elements can solve it.
void mooney_rivlin_rows(const bridge::Subject &subject, const lattice::TriangularLattice &sheet,
                        const Moduli &lattice_side, const Rows &rows)
{
  const bool is_judged = subject.judges(bridge::Law::mooney_rivlin);
  if (!subject.mooney_rivlin)
  {
    rows.add("plane-stress Mooney-Rivlin: no ratio gives a law that has a thickness all along the loading path", "1",
             {}, std::numeric_limits<double>::infinity(), {0., "there must be one"}, is_judged);
    return;
  }
  const bridge::Calibration &fit = *subject.mooney_rivlin;
  const continuum::MooneyRivlin law(fit.law);
  moduli_rows(subject, lattice_side, bridge::Law::mooney_rivlin, "plane-stress Mooney-Rivlin",
              continuum_moduli(subject, law), rows);

  const double on_lattice = bridge::homogeneous_response(sheet, subject.material, subject.deformation).energy_density;
  const double on_continuum = law.energy(bridge::to_continuum(subject.deformation));
  rows.add("energy density of the loaded sheet, plane-stress Mooney-Rivlin", "J/m^3", of_both(on_lattice, on_continuum),
           support::relative_error(on_continuum, on_lattice));
  rows.add("rms energy residual of plane-stress Mooney-Rivlin along the loading path", "1",
           of_continuum(fit.energy_residual), fit.energy_residual);
  if (subject.ratio_is_calibrated)
  {
    const Optimum found = optimum(subject, sheet);
    rows.add(std::string("calibrated ratio r = C2 / (C1 + C2)") +
               (found.is_end ? ", at the end of the search interval; error: slope of the residual inwards"
                             : "; error: slope of the residual there"),
             "1", of_continuum(fit.ratio), found.slope,
             {2e-6, "location of the minimum to 1e-9 times a curvature below 100; central difference with steps of "
                    "1e-4 times a third derivative below 1000"},
             is_judged);
  }
  else
    rows.add("given ratio r = C2 / (C1 + C2)", "1", of_continuum(fit.ratio));
  // Strong ellipticity: the slowest wave on the path has rho c^2 > 0; the error is its distance below zero.
  const double slowest = fit.smallest_acoustic_eigenvalue;
  rows.add(std::string("slowest rho c^2 / mu on the path, plane-stress Mooney-Rivlin") +
             (slowest < 0. ? ": the law loses ellipticity" : ""),
           "1", of_continuum(slowest), support::one_sided(-slowest), {0., "a sign"}, is_judged);
}

// The lattice against its own continuum law.
void cauchy_born_rows(const bridge::Subject &subject, const lattice::TriangularLattice &sheet, unsigned int samples,
                      const Rows &rows)
{
  support::LargestError energy_error, stress_error;
  for (const Eigen::Matrix2d &F : random_deformations(samples))
  {
    const bridge::LatticeResponse measured = bridge::homogeneous_response(sheet, subject.material, F);
    const Eigen::Matrix2d stress = bridge::to_lattice(subject.cauchy_born.first_piola_stress(bridge::to_continuum(F)));
    energy_error.add_relative(measured.energy_density, subject.cauchy_born.energy(bridge::to_continuum(F)));
    stress_error.add((measured.first_piola_stress - stress).norm() / stress.norm());
  }
  const std::string count = std::to_string(samples) + " random F";
  rows.add("energy density, Cauchy-Born, largest relative error, " + count, "1", {}, energy_error, equal_formulas);
  rows.add("first Piola stress, Cauchy-Born, largest relative error, " + count, "1", {}, stress_error, equal_formulas);
}

// The network law neglects only the lattice's dependence on direction: it is the mean over rotations of the lattice
// (theory-comparison.md, eq. (H.14)), and so differs from the lattice by no more than that dependence (eq. (H.15)).
void network_rows(const bridge::Subject &subject, const lattice::TriangularLattice &sheet, const Moduli &lattice_side,
                  unsigned int samples, const Rows &rows)
{
  moduli_rows(subject, lattice_side, bridge::Law::mooney_rivlin_network, "network",
              continuum_moduli(subject, subject.network), rows);
  support::LargestError energy_from_mean, stress_from_mean;
  for (const Eigen::Matrix2d &F : random_deformations(samples))
  {
    const bridge::NetworkComparison both(subject, sheet, F);
    energy_from_mean.add(both.energy_from_mean());
    stress_from_mean.add(both.stress_from_mean());
  }
  const auto add = [&](const std::string &quantity, const support::LargestError &error)
  {
    rows.add(quantity + ", network against the lattice's mean over rotations, largest relative error, " +
               std::to_string(samples) + " random F",
             "1", {}, error, equal_formulas, subject.judges(bridge::Law::mooney_rivlin_network));
  };
  add("energy density", energy_from_mean);
  add("first Piola stress", stress_from_mean);
  if (subject.deformation.isIdentity(1e-12))
    return; // neither stress nor a part of the energy that depends on the direction
  const bridge::NetworkComparison stretched(subject, sheet, subject.deformation);
  rows.add("energy density of the loaded sheet, network", "J/m^3",
           of_both(stretched.lattice_energy, stretched.network_energy, stretched.energy.mean(0)),
           stretched.energy_error());
  rows.add("first Piola stress of the loaded sheet, network, Frobenius norm", "Pa",
           of_both(stretched.lattice_stress.norm(), stretched.network_stress.norm(), stretched.stress.mean.norm()),
           stretched.stress_error());
}

// Theory.md, eq. (L.13), from the constants of the case.
struct Impact
{
  double duration, restitution; // [s], [-]
  double longest_step;          // [s]: the end of the contact falls anywhere into a step, where the force has a kink

  Impact(const bridge::Subject &subject, const input::Case &input)
  {
    const double pitch = std::sqrt(3.) / 2., d = subject.spacing;
    const lattice::Shell &nearest = subject.material.nearest;
    const double reduced_mass = 0.5 * subject.material.density * pitch * d * d;
    const double section = nearest.area_factor * pitch; // over d
    const double omega_0 = std::sqrt(input.contact_stiffness * section * stiffness_at_rest(nearest.law) / reduced_mass);
    const double beta = 0.5 * input.contact_viscosity * section * nearest.viscosity / reduced_mass;
    const double square = omega_0 * omega_0 - beta * beta, rate = std::sqrt(std::abs(square));
    duration = square > 0. ? std::atan2(2. * beta * rate, beta * beta - square) / rate
                           : 2. * std::log((beta + rate) / omega_0) / rate;
    restitution = std::exp(-beta * duration);
    // Overdamped contacts need more than 400 steps: x = beta duration has the relative error x^3 / 12 / steps^2.
    longest_step = duration / (400. * std::pow(support::largest_of({1., beta * duration / 5.}), 1.5));
  }
};

} // namespace

output::Results energy_claim(const bridge::Subject &subject, unsigned int samples)
{
  // The two outer rows and columns lack neighbours, the middle ones do not.
  const lattice::TriangularLattice sheet = subject.sheet(12.);
  output::Results results;
  const Rows rows(results, "energy", subject.name + ": ");
  rows.attempt("homogeneous deformations", [&] { cauchy_born_rows(subject, sheet, samples, rows); });
  std::optional<Moduli> on_lattice;
  rows.attempt("moduli and wave speeds at F = I",
               [&]
               {
                 // mu = dP_xy/dF_xy, lambda = dP_xx/dF_yy
                 const auto stress = [&](const Eigen::Matrix2d &F)
                 { return bridge::homogeneous_response(sheet, subject.material, F).first_piola_stress; };
                 on_lattice.emplace(stress_derivative(stress, 0, 1)(0, 1), stress_derivative(stress, 1, 1)(0, 0),
                                    subject.material.density);
                 moduli_rows(subject, *on_lattice, bridge::Law::cauchy_born, "Cauchy-Born",
                             continuum_moduli(subject, subject.cauchy_born), rows);
               });
  if (!on_lattice)
    return results;
  rows.attempt("network", [&] { network_rows(subject, sheet, *on_lattice, samples, rows); });
  rows.attempt("plane-stress Mooney-Rivlin along the loading path",
               [&] { mooney_rivlin_rows(subject, sheet, *on_lattice, rows); });
  return results;
}

output::Results contact_rows(const bridge::Subject &subject, const input::Case &input,
                             const std::function<void(lattice::ContactLaw &)> &planted)
{
  const double d = subject.spacing;
  const lattice::TriangularLattice sheet = subject.sheet();
  const lattice::Material material = lattice::without_memory(subject.material);
  lattice::ContactLaw law = lattice::contact_like_nearest_bond(sheet, material, input.contact_distance * d,
                                                               input.contact_stiffness, input.contact_viscosity);
  planted(law);
  const Impact impact(subject, input);

  // Two sites without bonds, in touch, along no line of the lattice.
  const Eigen::Vector2d direction(0.8, 0.6);
  const std::size_t left = sheet.index(sheet.rows() / 2, sheet.sites_in_row(0) / 2), right = left + 1;
  lattice::State state = lattice::homogeneous_state(sheet, material, Eigen::Matrix2d::Identity(), lattice::Edges::free);
  const double inverse_mass = state.inverse_mass[left];
  state.bonds.clear(sheet.n_places(), material.n_kinds(sheet));
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
  {
    const bool stays = place == left || place == right;
    state.removed[place] = sheet.is_site(place) && !stays ? 1 : 0;
    state.inverse_mass[place] = stays ? inverse_mass : 0.;
    state.lost_bonds[place] = stays ? 1 : 0;
  }
  // So slow that they overlap by a thousandth of the distance at most.
  const double speed = 1e-3 * law.distance / impact.duration;
  const Eigen::Vector2d common = 2. * speed * Eigen::Vector2d(direction.y(), -0.3);
  state.position.x[right] = state.position.x[left] + law.distance * (1. - 1e-12) * direction.x();
  state.position.y[right] = state.position.y[left] + law.distance * (1. - 1e-12) * direction.y();
  for (const auto &[place, sign] : {std::pair(left, 0.5), std::pair(right, -0.5)})
  {
    state.velocity.x[place] = common.x() + sign * speed * direction.x();
    state.velocity.y[place] = common.y() + sign * speed * direction.y();
  }
  lattice::TimeStepping stepping = input.fracture_time_stepping();
  stepping.step = support::smallest_of({stepping.step, impact.longest_step});
  lattice::Simulation simulation(sheet, material, std::move(state), stepping);
  simulation.enable_contact(law);
  while (simulation.state().time < 1.5 * impact.duration)
    simulation.step();

  const auto velocity = [&](std::size_t place) { return simulation.state().velocity.at(place); };
  const double restitution = (velocity(right) - velocity(left)).dot(direction) / speed;
  const double momentum = (0.5 * (velocity(right) + velocity(left)) - common).norm() / speed;
  const lattice::EnergyBalance energies = simulation.energies();
  output::Results results;
  const Rows rows(results, "energy",
                  subject.name + ": contact of two sites" +
                    (stepping.stages > 0 ? " (Runge-Kutta-Chebyshev), " : ", "));
  rows.add("coefficient of restitution against bonds and contact alone", "1",
           of_lattice(restitution, impact.restitution), support::relative_error(restitution, impact.restitution),
           {3e-4, "second order of 400 steps and more in the contact, and the kink of the force at its end: 1e-4 at "
                  "most, times three"});
  rows.add("momentum, change over that of approach", "1", of_lattice(momentum, 0.), momentum, {1e-10, "round-off"});
  const double imbalance = energies.imbalance() / energies.initial;
  rows.add("energy imbalance over the energy at the start", "1", of_lattice(imbalance, 0.), std::abs(imbalance),
           {1e-4, "time stepping while they touch: (w h)^2 / 4 with 400 steps, 6e-5"});
  return results;
}

ClaimOutcome check_energy(const ClaimInput &input)
{
  const bridge::Subject &subject = input.subject;
  ClaimOutcome outcome{energy_claim(subject, input.quick ? 200 : 2000), {}};
  if (!subject.is_stable())
    outcome.results.add(stability_row(subject, "energy"));
  if (input.entries.has_contact)
    outcome.results.attempt("energy", subject.name + ": contact",
                            [&] { outcome.results.add(contact_rows(subject, input.entries)); });
  WaveEnergyOptions options;
  options.states = wave_states(subject, true);
  if (input.quick)
    options.kd = {0.25, 0.5};
  outcome.add(wave_energy_claim(subject, options));
  return outcome;
}

} // namespace latcon::claims
