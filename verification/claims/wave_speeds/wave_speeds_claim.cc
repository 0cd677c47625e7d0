#include "verification/claims/wave_speeds/wave_speeds_claim.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "support/largest_error.h"
#include "verification/bridge/plane_waves.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/lattice_waves.h"
#include "verification/claims/order_fit.h"
#include "verification/claims/states.h"

namespace latcon::claims
{
namespace
{

const output::Tolerance lattice_tolerance{
  1e-6, "velocity Verlet with w h up to 0.12, extrapolated: 3/2560 of its fourth power, 2.4e-7, times 4"};
// The claim: at this wave number the gradient continuum has the lattice's speed to 1e-4 (with third-nearest neighbours
// to 1.8e-4).
constexpr double compared_kd = 0.25;
constexpr double gradient_tolerance = 1e-4;

// Frequency and decay of plane waves or of oscillations.
template <class Waves>
std::array<double, 2> frequencies(const Waves &waves)
{
  return {waves[0].frequency, waves[1].frequency};
}

void speeds_at(const bridge::Subject &subject, const Eigen::Matrix2d &F, const WaveSpeedsOptions &options,
               ClaimOutcome &outcome)
{
  const double d = subject.spacing;
  const lattice::Material material = lattice::without_dashpots(subject.material), of_runs = options.planted(material);
  const lattice::TriangularLattice sheet = subject.sheet(); // only its bonds matter
  const SubjectContinua media(subject);
  const auto exact = [&](const Eigen::Vector2d &K) { return frequencies(bridge::bloch_waves(sheet, material, F, K)); };
  const auto closed = [&](const WaveContinuum &medium, const Eigen::Vector2d &K)
  { return frequencies(continuum_waves(medium, F, K)); };
  const Rows rows(outcome.results, "wave-speeds", subject.name + ", " + state_name(F) + ": ");
  output::Table &table =
    outcome.table("wave_speeds", {"shells", "F_xx", "F_yy", "angle [deg]", "wave", "k d", "local [m/s]", "bloch [m/s]",
                                  "lattice [m/s]", "gradient [m/s]", "isotropic [m/s]", "fem [m/s]"});
  support::LargestError run_against_bloch, elements_against_closed, gradient_against_bloch, left_out;
  CommonOrder local_order, gradient_order;
  std::array<support::LargestError, 2> long_waves;
  for (const WaveDirection &direction : wave_directions(subject.orientation))
  {
    std::array<std::array<double, 2>, 2> longest{}, of_bloch{}; // speeds of the two longest waves run, by wave
    std::array<double, 2> longest_kd{};
    const Eigen::Vector2d N = unit_vector(direction, subject.orientation);
    for (std::size_t i = 0; i < options.kd.size(); ++i)
    {
      const WaveCell cell = wave_cell(d, subject.orientation, direction, options.kd[i]);
      const double k = cell.K.norm();
      const auto bloch = exact(cell.K), local = closed(media.local, cell.K), gradient = closed(media.gradient, cell.K),
                 isotropic = closed(media.isotropic, cell.K);
      // If a wave does not oscillate, its rows fail.
      std::array<double, 2> run{unknown, unknown}, elements = run;
      const auto attempt = [&](const std::string &side, const std::function<void()> &compute)
      {
        rows.attempt(support::text_of(side, ", waves at ", std::lround(angle(direction, subject.orientation)),
                                      " degrees, kd = ", options.kd[i]),
                     compute);
      };
      attempt("lattice run", [&] { run = frequencies(lattice_waves(cell, of_runs, F)); });
      attempt("finite elements",
              [&] { elements = frequencies(discrete_waves(media.gradient, F, cell.K, options.mesh)); });
      for (std::size_t w = 0; w < 2; ++w)
      {
        run_against_bloch.add_relative(run[w] / k, bloch[w] / k);
        elements_against_closed.add_relative(elements[w] / k, gradient[w] / k);
        if (i < 2)
        {
          longest[w][i] = run[w] / k;
          of_bloch[w][i] = bloch[w] / k;
          longest_kd[i] = k * d;
        }
        table.add({subject.name, F(0, 0), F(1, 1), angle(direction, subject.orientation), wave_names[w], k * d,
                   local[w] / k, bloch[w] / k, run[w] / k, gradient[w] / k, isotropic[w] / k, elements[w] / k});
      }
    }
    const Eigen::Vector2d K = compared_kd / d * N;
    for (std::size_t i = 0; i < order_kd.size(); ++i)
    {
      const Eigen::Vector2d of = order_kd[i] / d * N;
      const Eigen::Matrix2d bloch = bridge::bloch_matrices(sheet, material, F, of).stiffness;
      local_order.add(i, continuum_matrices(media.local, F, of).stiffness, bloch);
      gradient_order.add(i, continuum_matrices(media.gradient, F, of).stiffness, bloch);
    }
    for (std::size_t w = 0; w < 2; ++w)
    {
      gradient_against_bloch.add_relative(closed(media.gradient, K)[w] / K.norm(), exact(K)[w] / K.norm());
      // v^2 = c^2 (1 - alpha (kd)^2 + ...), a series in which c may be small: two waves give c.
      const double a = std::pow(longest_kd[0], 2), b = std::pow(longest_kd[1], 2);
      const auto extrapolated = [&](const std::array<double, 2> &v)
      { return std::sqrt((b * v[0] * v[0] - a * v[1] * v[1]) / (b - a)); };
      const double speed_of_long = F.isIdentity(1e-12)
                                     ? (w == 0 ? subject.theory.longitudinal_speed : subject.theory.shear_speed)
                                     : closed(media.local, N / d)[w] * d;
      long_waves[w].add_relative(extrapolated(longest[w]), speed_of_long);
      left_out.add_relative(extrapolated(of_bloch[w]), exact(1e-5 / d * N)[w] * d / 1e-5);
    }
  }

  const output::Tolerance remainder{
    std::clamp(left_out.error(), std::pow(options.kd[0] * options.kd[1] * 1.02 * 1.02, 2) / 40., 1e-2) +
      *lattice_tolerance,
    "next term of the series of v^2(k), half its coefficient below 1/40 (at most 4^2/720 for bonds up to 2 d long that "
    "pull) or that of Bloch waves, and time stepping"};
  for (std::size_t w = 0; w < 2; ++w)
    rows.add("long-wave speed, " + wave_names[w] + ", lattice run against closed form, worst of 4 directions", "m/s",
             of_lattice(long_waves[w]), long_waves[w], remainder);
  if (F.isIdentity(1e-12))
  {
    // Takes nothing from the side that moves: neither its cross-sections nor its masses.
    const double absolute = std::sqrt(absolute_shear_modulus(subject.material) / subject.material.density);
    rows.add("long-wave speed, S, lattice run against a, b, s and rho alone, worst of 4 directions", "m/s",
             of_lattice(long_waves[1].value(), absolute), support::relative_error(long_waves[1].value(), absolute),
             remainder);
  }
  rows.add("phase velocity, lattice run against Bloch, worst of all waves", "m/s", of_lattice(run_against_bloch),
           run_against_bloch, lattice_tolerance);
  rows.add("phase velocity, finite elements against their continuum, worst of all waves", "m/s",
           of_continuum(elements_against_closed), elements_against_closed,
           {discretisation_bound(options.mesh), "Ainsworth's dispersion error of the elements"});
  rows.add("phase velocity at kd = 0.25, gradient continuum against Bloch, worst of all waves", "m/s",
           of_continuum(gradient_against_bloch), gradient_against_bloch,
           {gradient_remainder(subject) * gradient_tolerance,
            "the next order, (kl)^4 / 480 for a bond of length l along the wave: 7.3e-5 for l = sqrt(3) d"},
           subject.judges_gradient(F));
  add_order(rows, "order in kd of the local continuum's error, all directions together", local_order, 2.);
  add_order(rows, "order in kd of the gradient continuum's error, all directions together", gradient_order, 4.,
            subject.judges_gradient(F));
}

// Damping of waves in all directions, against Bloch's: its order in kd, of the matrix since waves whose frequencies are
// close exchange their decays, and decays of the finite elements. Dashpots are scaled, so that the shortest waves are
// damped to a third of critical, and long ones measurably.
void damping_orders(const bridge::Subject &subject, const Eigen::Matrix2d &F, const WaveSpeedsOptions &options,
                    lattice::Material material, ClaimOutcome &outcome)
{
  const lattice::TriangularLattice sheet = subject.sheet(); // only its bonds matter
  support::LargestError ratio; // of critical damping
  for (const WaveDirection &direction : wave_directions(subject.orientation))
  {
    const Eigen::Vector2d K = largest_damped_kd / subject.spacing * unit_vector(direction, subject.orientation);
    for (const bridge::PlaneWave &wave : bridge::bloch_waves(sheet, material, F, K))
      ratio.add(0.5 * bridge::bloch_matrices(sheet, material, F, K).damping.norm() / wave.frequency);
  }
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (lattice::Shell *shell = material.in_shell(number))
      shell->viscosity *= 0.33 / ratio.error();

  SubjectContinua media(subject);
  media.local.viscosity = bridge::homogenised_viscosity(sheet, material);
  media.gradient.viscosity = bridge::homogenised_viscosity(sheet, material, subject.lengths.lattice);
  CommonOrder local_order, gradient_order;
  support::LargestError elements_against_closed;
  const Rows rows(outcome.results, "wave-speeds",
                  subject.name + ", " + state_name(F) + ", dashpots scaled to a third of critical: ");
  for (const WaveDirection &direction : wave_directions(subject.orientation))
  {
    for (std::size_t i = 0; i < order_kd.size(); ++i)
    {
      const Eigen::Vector2d K = order_kd[i] / subject.spacing * unit_vector(direction, subject.orientation);
      const Eigen::Matrix2d exact = bridge::bloch_matrices(sheet, material, F, K).damping;
      local_order.add(i, continuum_matrices(media.local, F, K).damping, exact);
      gradient_order.add(i, continuum_matrices(media.gradient, F, K).damping, exact);
    }
    const WaveCell cell = wave_cell(subject.spacing, subject.orientation, direction, largest_damped_kd);
    std::array<bridge::PlaneWave, 2> elements{};
    elements[0].decay = elements[1].decay = unknown;
    rows.attempt("finite elements, damped waves",
                 [&] { elements = discrete_waves(media.gradient, F, cell.K, options.mesh); });
    // By size, since dashpots may turn polarisations to between those of the two names.
    const auto closed = continuum_waves(media.gradient, F, cell.K);
    elements_against_closed.add_relative(support::smallest_of({elements[0].decay, elements[1].decay}),
                                         support::smallest_of({closed[0].decay, closed[1].decay}));
    elements_against_closed.add_relative(support::largest_of({elements[0].decay, elements[1].decay}),
                                         support::largest_of({closed[0].decay, closed[1].decay}));
  }
  add_order(rows, "order in kd of the local continuum's damping, all directions together", local_order, 2.);
  add_order(rows, "order in kd of the gradient continuum's damping, all directions together", gradient_order, 4.,
            subject.judges_gradient(F));
  rows.add(
    "decay at kd = 0.4, finite elements against their continuum, worst of 4 directions and both waves", "1/s",
    of_continuum(elements_against_closed), elements_against_closed,
    {2. * discretisation_bound(options.mesh), "Ainsworth's dispersion error of the elements, of squared frequencies"});
}

// Waves along x, whose two polarisations the dashpots keep apart by symmetry. Memories, which the continuum lacks, are
// left out; waves in them are those of the claim viscoelastic-waves.
void attenuation_at(const bridge::Subject &subject, const Eigen::Matrix2d &F, const WaveSpeedsOptions &options,
                    ClaimOutcome &outcome)
{
  const lattice::Material material = lattice::without_memory(subject.material);
  const lattice::TriangularLattice any = subject.sheet();
  const auto damped = [&](const Eigen::Vector2d &K)
  { return bridge::plane_waves(bridge::bloch_matrices(any, material, F, K), bridge::wave_normal(F, K)); };

  // Damping grows with kd; a third of critical is seen well within one period.
  constexpr double probe = 0.01, wanted_ratio = 0.33;
  double ratio = 0.; // of decay and frequency, infinite if a wave is overdamped
  for (const bridge::PlaneWave &wave : damped(Eigen::Vector2d(probe / subject.spacing, 0.)))
  {
    if (!std::isfinite(wave.frequency) || !std::isfinite(wave.decay))
      throw std::runtime_error("long waves have no frequency and decay");
    if (wave.decay / wave.frequency > ratio)
      ratio = wave.decay / wave.frequency;
  }
  const double kd = std::clamp(probe * wanted_ratio / ratio, 0.005, 0.5);
  const WaveCell cell = wave_cell(subject.spacing, subject.orientation, {1, 0}, kd);
  const double k = cell.K.norm();

  WaveContinuum medium = SubjectContinua(subject).gradient;
  medium.viscosity = bridge::homogenised_viscosity(any, material, subject.lengths.lattice);
  const std::array<bridge::PlaneWave, 2> theory = damped(cell.K), kelvin = continuum_waves(medium, F, cell.K);
  const Rows rows(
    outcome.results, "wave-speeds",
    support::text_of(subject.name, ", ", state_name(F), ", kd = ", std::round(1e4 * k * subject.spacing) / 1e4, ": "));
  // If a wave does not oscillate, its rows fail.
  std::vector<Oscillation> run(2, {unknown, unknown}), elements = run;
  rows.attempt("lattice run, damped waves",
               [&] { run = lattice_waves(cell, options.planted(material), F, options.integrator); });
  // Waves this long hardly feel the gradient energy: the error in space is below 1e-6.
  rows.attempt("finite elements, damped waves", [&] { elements = finite_element_waves(medium, F, cell.K, {4, 4}); });

  output::Table &table =
    outcome.table("attenuation",
                  {"shells", "F_xx", "F_yy", "angle [deg]", "wave", "k d", "theory_frequency [rad/s]",
                   "theory_decay [1/s]", "lattice_frequency [rad/s]", "lattice_decay [1/s]",
                   "continuum_frequency [rad/s]", "continuum_decay [1/s]", "fem_frequency [rad/s]", "fem_decay [1/s]"});
  // The theories over a decade of longer waves, for the plot.
  for (double fraction = 0.1; fraction < 0.95; fraction *= std::pow(10., 0.1))
  {
    const Eigen::Vector2d K = fraction * cell.K;
    const auto exact = damped(K), closed = continuum_waves(medium, F, K);
    for (std::size_t w = 0; w < 2; ++w)
      table.add({subject.name, F(0, 0), F(1, 1), 0., wave_names[w], fraction * k * subject.spacing, exact[w].frequency,
                 exact[w].decay, unknown, unknown, closed[w].frequency, closed[w].decay, unknown, unknown});
  }
  const bool chebyshev = options.integrator == input::Case::Integrator::runge_kutta_chebyshev;
  const output::Tolerance tolerance{1e-4, "average acceleration with 28 steps a period, extrapolated: (w h)^4 / 300, "
                                          "8e-6, times 4; of a decay of a third of the frequency three times as much; "
                                          "the lattice less"};
  for (std::size_t w = 0; w < 2; ++w)
  {
    table.add({subject.name, F(0, 0), F(1, 1), 0., wave_names[w], k * subject.spacing, theory[w].frequency,
               theory[w].decay, run[w].frequency, run[w].decay, kelvin[w].frequency, kelvin[w].decay,
               elements[w].frequency, elements[w].decay});
    const Rows of_wave = rows.about(wave_names[w] + ", ");
    const auto add = [&](const std::string &quantity, const std::string &unit, double lattice_value,
                         double element_value, double bloch, double closed)
    {
      of_wave.add(quantity + ", lattice" + (chebyshev ? " (Runge-Kutta-Chebyshev)" : "") +
                    " and finite elements each against its theory",
                  unit, of_both(lattice_value, element_value, bloch),
                  support::largest_of(
                    {support::relative_error(lattice_value, bloch), support::relative_error(element_value, closed)}),
                  tolerance);
    };
    add("damped frequency", "rad/s", run[w].frequency, elements[w].frequency, theory[w].frequency, kelvin[w].frequency);
    add("decay", "1/s", run[w].decay, elements[w].decay, theory[w].decay, kelvin[w].decay);
    // Of a wave so long that the tolerance cannot hide an error of 1 %, whatever the dashpots.
    const Eigen::Vector2d K = cell.K * support::smallest_of({1., 0.15 / (k * subject.spacing)});
    const double closed = continuum_waves(medium, F, K)[w].decay, exact = damped(K)[w].decay;
    of_wave.add(std::string("decay, gradient continuum against Bloch") + (K.norm() < k ? ", at kd = 0.15" : ""), "1/s",
                of_continuum(closed, exact), support::relative_error(closed, exact),
                {0.6 * std::pow(subject.lengths.lattice * K.norm(), 4) + 1e-10,
                 "the next order, (kl)^4 / 240 of the longest bond, sqrt(12) l_d; round-off of decays"});
  }
  damping_orders(subject, F, options, material, outcome);
}

} // namespace

ClaimOutcome wave_speeds_claim(const bridge::Subject &subject, const WaveSpeedsOptions &options)
{
  ClaimOutcome outcome;
  const Rows rows(outcome.results, "wave-speeds", subject.name + ", ");
  for (const Eigen::Matrix2d &F : options.states)
  {
    rows.attempt(state_name(F) + ": waves", [&] { speeds_at(subject, F, options, outcome); });
    rows.attempt(state_name(F) + ": waves in the network", [&] { network_waves(subject, F, options.mesh, outcome); });
  }
  // Not `> 0.`, which would skip a viscosity that is NaN.
  bool has_dashpots = false;
  for (std::size_t number = 0; number < lattice::n_shells; ++number)
    if (const lattice::Shell *shell = subject.material.in_shell(number))
      has_dashpots = has_dashpots || shell->viscosity != 0.;
  if (has_dashpots)
    for (const Eigen::Matrix2d &F : options.damped_states)
      rows.attempt(state_name(F) + ": damped waves", [&] { attenuation_at(subject, F, options, outcome); });
  return outcome;
}

ClaimOutcome check_wave_speeds(const ClaimInput &input)
{
  const bridge::Subject &subject = input.subject;
  WaveSpeedsOptions options;
  options.states = wave_states(subject, input.quick);
  options.damped_states = wave_states(subject, true);
  if (!subject.deformation.isDiagonal(0.)) // the dashpots couple the two waves along x
    options.damped_states.resize(1);
  options.integrator = input.entries.integrator;
  if (input.quick)
  {
    options.kd = {0.1, 0.5};
    options.mesh.cells = 4;
    options.damped_states = {options.damped_states.back()};
  }
  ClaimOutcome outcome = wave_speeds_claim(subject, options);
  if (!subject.is_stable())
    outcome.results.add(stability_row(subject, "wave-speeds"));
  else if (input.entries.left_end == input::Case::End::absorbing ||
           input.entries.right_end == input::Case::End::absorbing)
    outcome.results.attempt("wave-speeds", subject.name + ": absorbing end",
                            [&] { outcome.results.add(absorbing_end_rows(subject)); });
  return outcome;
}

} // namespace latcon::claims
