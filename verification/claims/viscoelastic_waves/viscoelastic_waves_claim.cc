#include "verification/claims/viscoelastic_waves/viscoelastic_waves_claim.h"

#include <cmath>
#include <limits>
#include <memory>
#include <sstream>

#include "support/largest_error.h"
#include "verification/bridge/bloch.h"
#include "verification/bridge/homogenisation.h"
#include "verification/bridge/homogenised_memory.h"
#include "verification/bridge/memory_waves.h"
#include "verification/claims/continuum_waves.h"
#include "verification/claims/rows.h"
#include "verification/claims/state_name.h"
#include "verification/claims/viscoelastic_waves/element_waves.h"
#include "verification/claims/viscoelastic_waves/mode_run.h"

namespace latcon::claims
{
namespace
{

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

const output::Tolerance frequency_tolerance{1e-6, "extrapolated time stepping, three terms of 1.2e-7 (mode_run.cc)"};
const output::Tolerance decay_tolerance{
  2e-5, "that of frequencies, of decays down to a twentieth of the frequency to which their error is relative"};
// Modulus of the swept branch over the stiffness of a bond.
constexpr double swept_ratio = 0.5;
constexpr double swept_kd = 0.25;
const output::Tolerance element_tolerance{
  2e-5, "extrapolated time stepping, (w h)^4 / 320 <= 5e-6, as much from the update of branches (V.7), 7e-7 in space "
        "(Ainsworth), times two"};
constexpr WaveMesh element_mesh{4, 4};

// Local continuum of a lattice with branches.
struct Medium
{
  std::unique_ptr<continuum::Viscosity> viscosity;
  std::unique_ptr<continuum::FibreMemory> memory;
  WaveContinuum waves;

  Medium(const bridge::Subject &subject, const WaveCell &cell, const lattice::Material &material)
    : viscosity(bridge::homogenised_viscosity(cell.sheet, material)),
      memory(bridge::homogenised_memory(cell.sheet, material)), waves{{subject.cauchy_born},
                                                                      {subject.material.density},
                                                                      viscosity.get(),
                                                                      memory.get()}
  {
  }
};

// Comparison of runs with the closed form, and the table of the waves.
class WaveComparison
{
public:
  WaveComparison(const bridge::Subject &subject, const Eigen::Matrix2d &F, const ViscoelasticWavesOptions &options,
                 ClaimOutcome &outcome)
    : rows(outcome.results, "viscoelastic-waves", subject.name + ", " + state_name(F) + ": "), subject_(subject), F_(F),
      options_(options),
      table_(outcome.table("viscoelastic_waves",
                           {"shells", "F_xx", "F_yy", "part", "wave", "k d", "w tau", "rubbery [rad/s]",
                            "glassy [rad/s]", "theory_frequency [rad/s]", "theory_decay [1/s]",
                            "lattice_frequency [rad/s]", "lattice_decay [1/s]"})),
      element_table_(
        outcome.table("viscoelastic_elements", {"shells", "F_xx", "F_yy", "part", "wave", "k d", "w tau",
                                                "rubbery [rad/s]", "glassy [rad/s]", "continuum_frequency [rad/s]",
                                                "continuum_decay [1/s]", "fem_frequency [rad/s]", "fem_decay [1/s]"}))
  {
  }

  // Runs one wave. @param scaled_time w tau, for the table
  Oscillation compare(const std::string &part, const WaveCell &cell, const lattice::Material &material, std::size_t w,
                      double scaled_time)
  {
    const bridge::MemoryWave wave = bridge::memory_waves(cell.sheet, material, F_, cell.K)[w];
    const lattice::Material planted = options_.planted ? options_.planted(material) : material;
    Oscillation run{nothing, nothing, 0.};
    std::ostringstream where;
    where << part << ", wave " << wave_names[w] << ", w tau = " << scaled_time;
    rows.attempt(where.str(), [&] { run = run_wave(cell, planted, F_, wave); });
    const auto [rubbery, glassy] = limits(cell, material, w);
    frequency_.add_relative(run.frequency, wave.frequency());
    decay_.add(std::abs(run.decay - wave.decay()) / wave.frequency(), run.decay, wave.decay());
    // Overdamped limits of dashpots are no bounds.
    outside_.add(support::largest_of(
      {support::one_sided(rubbery / run.frequency - 1.), support::one_sided(run.frequency / glassy - 1.)}));
    table_.add({subject_.name, F_(0, 0), F_(1, 1), part, std::string(wave_names[w]), cell.K.norm() * subject_.spacing,
                scaled_time, rubbery, glassy, wave.frequency(), wave.decay(), run.frequency, run.decay});
    return run;
  }

  // Runs one wave of the local continuum of `material` on finite elements, against its own complex modulus.
  Oscillation compare_elements(const std::string &part, const WaveCell &cell, const lattice::Material &material,
                               std::size_t w, double scaled_time)
  {
    const Medium right(subject_, cell, material);
    const bridge::MemoryWave wave = continuum_memory_waves(right.waves, F_, cell.K)[w];
    ElementWave run{{nothing, nothing, 0.}, nothing, nothing};
    std::ostringstream where;
    where << part << ", finite elements, wave " << wave_names[w] << ", w tau = " << scaled_time;
    rows.attempt(where.str(),
                 [&]
                 {
                   const Medium planted(subject_, cell, options_.planted ? options_.planted(material) : material);
                   run = run_element_wave(planted.waves, F_, cell.K, wave, element_mesh);
                 });
    const auto [rubbery, glassy] = limits(right.waves, cell.K, w);
    frequency_.add_relative(run.oscillation.frequency, wave.frequency());
    decay_.add(std::abs(run.oscillation.decay - wave.decay()) / wave.frequency(), run.oscillation.decay, wave.decay());
    outside_.add(support::largest_of({support::one_sided(rubbery / run.oscillation.frequency - 1.),
                                      support::one_sided(run.oscillation.frequency / glassy - 1.)}));
    imbalance_.add(run.imbalance / run.imbalance_tolerance);
    element_table_.add({subject_.name, F_(0, 0), F_(1, 1), part, std::string(wave_names[w]),
                        cell.K.norm() * subject_.spacing, scaled_time, rubbery, glassy, wave.frequency(), wave.decay(),
                        run.oscillation.frequency, run.oscillation.decay});
    return run.oscillation;
  }

  // Frequencies without dashpots of the relaxed and of the unrelaxed lattice [rad/s].
  std::array<double, 2> limits(const WaveCell &cell, const lattice::Material &material, std::size_t w) const
  {
    const lattice::Material elastic = lattice::without_dashpots(material);
    const Eigen::Vector2d normal = bridge::wave_normal(F_, cell.K);
    bridge::WaveMatrices matrices = bridge::bloch_matrices(cell.sheet, elastic, F_, cell.K);
    const double rubbery = bridge::plane_waves(matrices, normal)[w].frequency;
    matrices.stiffness += bridge::glassy_stiffness(cell.sheet, material, F_, cell.K);
    return {rubbery, bridge::plane_waves(matrices, normal)[w].frequency};
  }

  // The same for the continuum.
  std::array<double, 2> limits(const WaveContinuum &medium, const Eigen::Vector2d &K, std::size_t w) const
  {
    const Eigen::Vector2d normal = bridge::wave_normal(F_, K);
    bridge::WaveMatrices matrices = continuum_matrices({medium.constitution, medium.inertia}, F_, K);
    const double rubbery = bridge::plane_waves(matrices, normal)[w].frequency;
    for (const bridge::BranchMatrix &branch : branch_matrices(medium, F_, K))
      matrices.stiffness += branch.stiffness;
    return {rubbery, bridge::plane_waves(matrices, normal)[w].frequency};
  }

  // Rows on all waves since the last call.
  void add_rows(const std::string &part)
  {
    rows.add(part + ", frequency, lattice run against complex modulus, worst of all waves", "rad/s",
             of_lattice(frequency_), frequency_, frequency_tolerance);
    rows.add(part + ", decay, lattice run against complex modulus, worst of all waves, error over the frequency", "1/s",
             of_lattice(decay_), decay_, decay_tolerance);
    frequency_ = decay_ = support::LargestError();
  }
  const support::LargestError &outside() const { return outside_; }

  const Rows rows;

  // Rows on all waves of finite elements since the last call.
  void add_element_rows(const std::string &part)
  {
    rows.add(part + ", frequency, finite elements against complex modulus, worst of all waves", "rad/s",
             of_continuum(frequency_), frequency_, element_tolerance);
    rows.add(part + ", decay, finite elements against complex modulus, worst of all waves, error over the frequency",
             "1/s", of_continuum(decay_), decay_, element_tolerance);
    rows.add(part + ", energy imbalance of finite elements over its bound, worst of all waves", "1", {}, imbalance_,
             {1., "the bound (V.8)"});
    frequency_ = decay_ = imbalance_ = support::LargestError();
  }

private:
  const bridge::Subject &subject_;
  Eigen::Matrix2d F_;
  const ViscoelasticWavesOptions &options_;
  output::Table &table_, &element_table_;
  support::LargestError frequency_, decay_, outside_, imbalance_;
};

// Abscissa of the largest ordinate: the vertex of the parabola through the largest one and its neighbours.
double peak(const std::vector<double> &x, const std::vector<double> &y)
{
  std::size_t i = 1;
  for (std::size_t j = 1; j + 1 < y.size(); ++j)
    if (y[j] > y[i])
      i = j;
  const double a = (y[i] - y[i - 1]) / (x[i] - x[i - 1]), b = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
  const double curvature = (b - a) / (x[i + 1] - x[i - 1]);
  return 0.5 * (x[i] + x[i - 1]) - 0.5 * a / curvature;
}

// The relaxation time of one branch per bond is swept in the continuum.
void sweep_elements(const bridge::Subject &subject, const Eigen::Matrix2d &F, const ViscoelasticWavesOptions &options,
                    const WaveCell &cell, ClaimOutcome &outcome)
{
  const std::string part = "one branch";
  WaveComparison comparison(subject, F, options, outcome);
  const lattice::Material elastic = lattice::without_dashpots(subject.material);
  const WaveContinuum relaxed{{subject.cauchy_born}, {subject.material.density}};
  support::LargestError peaks;
  for (std::size_t w = 0; w < 2; ++w)
  {
    const double frequency =
      bridge::plane_waves(continuum_matrices(relaxed, F, cell.K), bridge::wave_normal(F, cell.K))[w].frequency;
    std::vector<double> logarithms, decays, in_theory;
    for (const double scaled : options.element_frequencies)
    {
      const lattice::Material material = with_branches(elastic, {swept_ratio}, {scaled / frequency});
      logarithms.push_back(std::log(scaled));
      decays.push_back(comparison.compare_elements(part, cell, material, w, scaled).decay);
      in_theory.push_back(continuum_memory_waves(Medium(subject, cell, material).waves, F, cell.K)[w].decay());
    }
    peaks.add_relative(std::exp(peak(logarithms, decays)), std::exp(peak(logarithms, in_theory)));
  }
  comparison.add_element_rows(part);
  comparison.rows.add(
    part + ", frequency of finite elements below the rubbery or above the glassy limit, worst of all waves", "1", {},
    comparison.outside(), element_tolerance);
  // Decays a factor of three beside the peak are smaller by 0.05 of the frequency, which makes the error of the vertex
  // 45 times that of the decays.
  comparison.rows.add(
    part + ", w tau at the largest decay of finite elements, worst of both waves", "1", of_continuum(peaks), peaks,
    {1e-3, "vertex of a parabola through decays that differ by 0.05 of the frequency, known to 2e-5: 45 "
           "times their error"});
}

// One branch per bond whose relaxation time is swept at a fixed wavelength.
void sweep(const bridge::Subject &subject, const Eigen::Matrix2d &F, const ViscoelasticWavesOptions &options,
           bool has_elements, ClaimOutcome &outcome)
{
  const std::string part = "one branch";
  WaveComparison comparison(subject, F, options, outcome);
  const WaveCell cell = wave_cell(subject.spacing, subject.orientation, {1, 0}, swept_kd);
  const lattice::Material elastic = lattice::without_dashpots(subject.material);
  support::LargestError peaks;
  for (std::size_t w = 0; w < 2; ++w)
  {
    const double frequency = bridge::bloch_waves(cell.sheet, elastic, F, cell.K)[w].frequency;
    std::vector<double> logarithms, decays, in_theory;
    for (const double scaled : options.frequencies)
    {
      const lattice::Material material = with_branches(elastic, {swept_ratio}, {scaled / frequency});
      logarithms.push_back(std::log(scaled));
      decays.push_back(comparison.compare(part, cell, material, w, scaled).decay);
      in_theory.push_back(bridge::memory_waves(cell.sheet, material, F, cell.K)[w].decay());
    }
    peaks.add_relative(std::exp(peak(logarithms, decays)), std::exp(peak(logarithms, in_theory)));
  }
  comparison.add_rows(part);
  comparison.rows.add(part + ", frequency below the rubbery or above the glassy limit, worst of all waves", "1", {},
                      comparison.outside(), frequency_tolerance);
  // Decays near the peak, which differ by a few percent, are known to 1e-6.
  comparison.rows.add(part + ", w tau at the largest decay, worst of both waves", "1", of_lattice(peaks), peaks,
                      {1e-3, "vertex of a parabola through decays that differ by a few percent, known to "
                             "1e-6"});
  if (has_elements)
    sweep_elements(subject, F, options, cell, outcome);
  // w^2 = c^2 k^2 (1 - alpha (kd)^2 + ...) with alpha <= 1/4 for bonds up to sqrt3 d long, 1/3 for those of 2 d.
  const double half_alpha = subject.material.third_nearest ? 1. / 6. : 0.125;
  const WaveContinuum local{{subject.cauchy_born}, {subject.material.density}};
  const std::array<bridge::PlaneWave, 2> continuum =
    bridge::plane_waves(continuum_matrices(local, F, cell.K), bridge::wave_normal(F, cell.K));
  support::LargestError rubbery;
  for (std::size_t w = 0; w < 2; ++w)
    rubbery.add_relative(comparison.limits(cell, elastic, w)[0], continuum[w].frequency);
  comparison.rows.add("frequency in the rubbery limit, lattice against local continuum, worst of both waves", "rad/s",
                      of_both(rubbery.value(), rubbery.reference()), rubbery,
                      {half_alpha * std::pow(cell.K.norm() * subject.spacing, 2),
                       "alpha (kd)^2 / 2 with alpha <= 1/4, with third-nearest neighbours 1/3"});
}

// The branches of the material, with its dashpots.
void own_branches(const bridge::Subject &subject, const Eigen::Matrix2d &F, const ViscoelasticWavesOptions &options,
                  bool has_elements, ClaimOutcome &outcome)
{
  constexpr double largest_ratio = 0.5; // of decay and frequency, seen well within a period
  WaveComparison comparison(subject, F, options, outcome);
  for (const double kd : {0.5, 0.2, 0.1, 0.05, 0.02, 0.01})
  {
    const auto cell_of = [&](double of) { return wave_cell(subject.spacing, subject.orientation, {1, 0}, of); };
    const WaveCell cell = cell_of(kd);
    const auto waves = bridge::memory_waves(cell.sheet, subject.material, F, cell.K);
    const double ratio =
      support::largest_of({waves[0].decay() / waves[0].frequency(), waves[1].decay() / waves[1].frequency()});
    if (!(ratio <= largest_ratio) && kd > 0.01) // also where a wave does not oscillate
      continue;
    for (const double of : {kd, 0.5 * kd})
      for (std::size_t w = 0; w < 2; ++w)
        comparison.compare("own branches", cell_of(of), subject.material, w, nothing);
    comparison.add_rows("own branches");
    if (!has_elements)
      break;
    for (std::size_t w = 0; w < 2; ++w)
      comparison.compare_elements("own branches", cell, subject.material, w, nothing);
    comparison.add_element_rows("own branches");
    break;
  }
}

} // namespace

ClaimOutcome viscoelastic_waves_claim(const bridge::Subject &subject, const ViscoelasticWavesOptions &options)
{
  ClaimOutcome outcome;
  for (std::size_t state = 0; state < options.states.size(); ++state)
  {
    const Eigen::Matrix2d &F = options.states[state];
    const bool has_elements = state < options.element_states && !options.element_frequencies.empty();
    const Rows rows(outcome.results, "viscoelastic-waves", subject.name + ", " + state_name(F) + ": ");
    rows.attempt("one branch", [&] { sweep(subject, F, options, has_elements, outcome); });
    if (has_branches(subject.material))
      rows.attempt("own branches", [&] { own_branches(subject, F, options, has_elements, outcome); });
  }
  return outcome;
}

} // namespace latcon::claims
