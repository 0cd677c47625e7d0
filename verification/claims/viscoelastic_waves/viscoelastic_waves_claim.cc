#include "verification/claims/viscoelastic_waves/viscoelastic_waves_claim.h"

#include <cmath>

#include "support/largest_error.h"
#include "verification/bridge/homogenisation.h"
#include "verification/bridge/plane_waves.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/continuum_waves.h"
#include "verification/claims/lattice_waves.h"
#include "verification/claims/order_fit.h"
#include "verification/claims/states.h"

namespace latcon::claims
{
namespace
{

const output::Tolerance frequency_tolerance{1e-6, "extrapolated time stepping, three terms of 1.2e-7"};
const output::Tolerance decay_tolerance{
  2e-5, "that of frequencies, of decays down to a twentieth of the rate to whose magnitude their error is relative"};
// Modulus of the swept branch over the stiffness of a bond.
constexpr double swept_ratio = 0.5;
constexpr double swept_kd = 0.25;
const output::Tolerance element_tolerance{
  2e-5, "extrapolated time stepping, (w h)^4 / 320 <= 5e-6, as much from the update of branches (V.7), up to 4e-6 in "
        "space (Ainsworth), rounded up"};
constexpr WaveMesh element_mesh{4, 4};

// Gradient continuum of a lattice with these dashpots and branches. @param sheet only its bonds matter
WaveContinuum gradient_continuum(const bridge::Subject &subject, const lattice::TriangularLattice &sheet,
                                 const lattice::Material &material)
{
  WaveContinuum medium = SubjectContinua(subject).gradient;
  medium.viscosity = bridge::homogenised_viscosity(sheet, material, subject.lengths.lattice);
  medium.memory = bridge::homogenised_memory(sheet, material, subject.lengths.lattice);
  return medium;
}

// Sum of the stiffness of branches.
Eigen::Matrix2d sum(const std::vector<bridge::BranchMatrix> &branches)
{
  Eigen::Matrix2d total = Eigen::Matrix2d::Zero();
  for (const bridge::BranchMatrix &branch : branches)
    total += branch.stiffness;
  return total;
}

// Comparison of runs with the closed form of their side, the lattice or finite elements of its gradient continuum, and
// the table of the waves.
class WaveComparison
{
public:
  WaveComparison(const bridge::Subject &subject, const Eigen::Matrix2d &F, const ViscoelasticWavesOptions &options,
                 bool has_elements, ClaimOutcome &outcome)
    : rows(outcome.results, "viscoelastic-waves", subject.name + ", " + state_name(F) + ": "), subject_(subject), F_(F),
      options_(options), has_elements_(has_elements)
  {
    const std::string theory = has_elements ? "continuum" : "theory", run = has_elements ? "fem" : "lattice";
    table_ = &outcome.table(has_elements ? "viscoelastic_elements" : "viscoelastic_waves",
                            {"shells", "F_xx", "F_yy", "part", "wave", "k d", "w tau", "rubbery [rad/s]",
                             "glassy [rad/s]", theory + "_frequency [rad/s]", theory + "_decay [1/s]",
                             run + "_frequency [rad/s]", run + "_decay [1/s]"});
  }

  // Frequency without dashpots and branches [rad/s].
  double rubbery(const WaveCell &cell, const lattice::Material &material, std::size_t w) const
  {
    return bridge::plane_waves(relaxed(cell, material), bridge::wave_normal(F_, cell.K))[w].frequency;
  }

  // In closed form.
  bridge::MemoryWave theory(const WaveCell &cell, const lattice::Material &material, std::size_t w) const
  {
    return has_elements_ ? continuum_memory_waves(gradient_continuum(subject_, cell.sheet, material), F_, cell.K)[w]
                         : bridge::memory_waves(cell.sheet, material, F_, cell.K)[w];
  }

  // Runs one wave. @param scaled_time w tau, for the table
  Oscillation compare(const std::string &part, const WaveCell &cell, const lattice::Material &material, std::size_t w,
                      double scaled_time)
  {
    const bridge::MemoryWave wave = theory(cell, material, w);
    // Of its polarisation p, without dashpots: p D p <= |s|^2 <= p (D + G) p with one branch of stiffness G, which are
    // the squared frequencies if it is always or never relaxed.
    const Eigen::Matrix2d D = relaxed(cell, material).stiffness;
    const auto along = [&wave](const Eigen::Matrix2d &M)
    { return std::sqrt(wave.polarisation.dot(M * wave.polarisation).real() / wave.polarisation.squaredNorm()); };
    const double lowest = along(D), highest = along(D + sum(branches(cell, material)));
    ElementWave run{{unknown, unknown}, unknown, unknown};
    rows.attempt(support::text_of(part, has_elements_ ? ", finite elements" : "", ", wave ", wave_names[w],
                                  ", w tau = ", scaled_time),
                 [&]
                 {
                   const lattice::Material planted = options_.planted(material);
                   if (has_elements_)
                     run =
                       element_wave(gradient_continuum(subject_, cell.sheet, planted), F_, cell.K, wave, element_mesh);
                   else
                     run.oscillation = lattice_wave(cell, planted, F_, wave);
                 });
    const auto &[frequency, decay] = run.oscillation;
    const double magnitude = std::hypot(frequency, decay);
    frequency_.add(std::abs(frequency - wave.frequency()) / std::abs(wave.rate), frequency, wave.frequency());
    decay_.add(std::abs(decay - wave.decay()) / std::abs(wave.rate), decay, wave.decay());
    outside_.add(
      support::largest_of({support::one_sided(lowest / magnitude - 1.), support::one_sided(magnitude / highest - 1.)}));
    imbalance_.add(run.imbalance / run.imbalance_tolerance);
    table_->add({subject_.name, F_(0, 0), F_(1, 1), part, wave_names[w], cell.K.norm() * subject_.spacing, scaled_time,
                 lowest, highest, wave.frequency(), wave.decay(), frequency, decay});
    return run.oscillation;
  }

  // Rows on all waves.
  void add_rows(const std::string &part) const
  {
    const std::string against =
      (has_elements_ ? "finite elements" : "lattice run") + std::string(" against complex modulus");
    rows.add(part + ", frequency, " + against + ", worst of all waves", "rad/s", sides(frequency_), frequency_,
             has_elements_ ? element_tolerance : frequency_tolerance);
    rows.add(part + ", decay, " + against + ", worst of all waves, error over the magnitude of the rate", "1/s",
             sides(decay_), decay_, has_elements_ ? element_tolerance : decay_tolerance);
    if (has_elements_)
      rows.add(part + ", energy imbalance of finite elements over its bound, worst of all waves", "1", {}, imbalance_,
               {1., "the bound (V.8)"});
  }

  // Rows of a sweep. @param peaks w tau at the largest decay
  void add_sweep_rows(const std::string &part, const support::LargestError &peaks) const
  {
    const std::string of_elements = has_elements_ ? " of finite elements" : "";
    rows.add(part + ", magnitude of the rate" + of_elements +
               " below the rubbery or above the glassy limit, worst of all waves",
             "1", {}, outside_, has_elements_ ? element_tolerance : frequency_tolerance);
    // Decays of finite elements a factor of three beside the peak are smaller by 0.05 of the frequency, which makes
    // the error of the vertex 45 times that of the decays. In the lattice decays near the peak, which differ by a few
    // percent, are known to 1e-6.
    rows.add(part + ", w tau at the largest decay" + of_elements + ", worst of both waves", "1", sides(peaks), peaks,
             {1e-3, has_elements_
                      ? "vertex of a parabola through decays that differ by 0.05 of the frequency, known to "
                        "2e-5: 45 times their error"
                      : "vertex of a parabola through decays that differ by a few percent, known to 1e-6"});
  }

  const Rows rows;

private:
  bridge::WaveMatrices relaxed(const WaveCell &cell, const lattice::Material &material) const
  {
    return has_elements_ ? continuum_matrices(SubjectContinua(subject_).gradient, F_, cell.K)
                         : bridge::bloch_matrices(cell.sheet, lattice::without_dashpots(material), F_, cell.K);
  }
  std::vector<bridge::BranchMatrix> branches(const WaveCell &cell, const lattice::Material &material) const
  {
    return has_elements_ ? branch_matrices(gradient_continuum(subject_, cell.sheet, material), F_, cell.K)
                         : bridge::branch_matrices(cell.sheet, material, F_, cell.K);
  }
  Sides sides(const support::LargestError &error) const
  {
    return has_elements_ ? of_continuum(error) : of_lattice(error);
  }

  const bridge::Subject &subject_;
  Eigen::Matrix2d F_;
  const ViscoelasticWavesOptions &options_;
  bool has_elements_;
  output::Table *table_;
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

// One branch per bond whose relaxation time is swept at a fixed wavelength. @param frequencies w tau
void sweep(WaveComparison &comparison, const lattice::Material &elastic, const WaveCell &cell,
           const std::vector<double> &frequencies)
{
  const std::string part = "one branch";
  support::LargestError peaks;
  for (std::size_t w = 0; w < 2; ++w)
  {
    const double frequency = comparison.rubbery(cell, elastic, w);
    std::vector<double> logarithms, decays, in_theory;
    for (const double scaled : frequencies)
    {
      const lattice::Material material = with_branches(elastic, {swept_ratio}, {scaled / frequency});
      const double decay = comparison.theory(cell, material, w).decay();
      if (std::isnan(decay))
        continue; // the branch overdamps a slow wave
      logarithms.push_back(std::log(scaled));
      decays.push_back(comparison.compare(part, cell, material, w, scaled).decay);
      in_theory.push_back(decay);
    }
    if (decays.size() > 2 && decays.size() == frequencies.size())
      peaks.add_relative(std::exp(peak(logarithms, decays)), std::exp(peak(logarithms, in_theory)));
  }
  comparison.add_rows(part);
  if (frequencies.size() > 2)
    comparison.add_sweep_rows(part, peaks);
}

void one_branch(const bridge::Subject &subject, const Eigen::Matrix2d &F, const ViscoelasticWavesOptions &options,
                bool has_elements, ClaimOutcome &outcome)
{
  WaveComparison comparison(subject, F, options, false, outcome);
  const WaveCell cell = wave_cell(subject.spacing, subject.orientation, {1, 0}, swept_kd);
  const lattice::Material elastic = lattice::without_dashpots(subject.material);
  sweep(comparison, elastic, cell, options.frequencies);
  WaveComparison of_elements(subject, F, options, true, outcome);
  if (has_elements)
    sweep(of_elements, elastic, cell, options.element_frequencies);
  support::LargestError rubbery;
  for (std::size_t w = 0; w < 2; ++w)
    rubbery.add_relative(comparison.rubbery(cell, elastic, w), of_elements.rubbery(cell, elastic, w));
  comparison.rows.add("frequency in the rubbery limit, lattice against gradient continuum, worst of both waves",
                      "rad/s", of_both(rubbery.value(), rubbery.reference()), rubbery,
                      {gradient_remainder(subject) * 1e-4 * std::pow(cell.K.norm() * subject.spacing / swept_kd, 4),
                       "the next order, (kl)^4 / 480 for a bond of length l along the wave: 7.3e-5 for l = sqrt(3) d"},
                      subject.judges_gradient(F));
}

// Order in kd of the branches of waves in all directions, against Bloch's: of the matrix, since a slow wave need not
// oscillate with one.
void branch_orders(const bridge::Subject &subject, const Eigen::Matrix2d &F, const Rows &rows)
{
  const lattice::TriangularLattice sheet = subject.sheet(); // only its bonds matter
  const lattice::Material material = with_branches(subject.material, {swept_ratio}, {1.});
  WaveContinuum local = SubjectContinua(subject).local;
  local.memory = bridge::homogenised_memory(sheet, material);
  const WaveContinuum gradient = gradient_continuum(subject, sheet, material);
  CommonOrder of_local, of_gradient;
  for (const WaveDirection &direction : wave_directions(subject.orientation))
    for (std::size_t i = 0; i < order_kd.size(); ++i)
    {
      const Eigen::Vector2d K = order_kd[i] / subject.spacing * unit_vector(direction, subject.orientation);
      const Eigen::Matrix2d bloch = sum(bridge::branch_matrices(sheet, material, F, K));
      of_local.add(i, sum(branch_matrices(local, F, K)), bloch);
      of_gradient.add(i, sum(branch_matrices(gradient, F, K)), bloch);
    }
  add_order(rows, "order in kd of the local continuum's branch, all directions together", of_local, 2.);
  add_order(rows, "order in kd of the gradient continuum's branch, all directions together", of_gradient, 4.,
            subject.judges_gradient(F));
}

// The branches of the material, with its dashpots.
void own_branches(const bridge::Subject &subject, const Eigen::Matrix2d &F, const ViscoelasticWavesOptions &options,
                  bool has_elements, ClaimOutcome &outcome)
{
  const std::string part = "own branches";
  constexpr double largest_ratio = 0.5; // of decay and frequency, seen well within a period
  WaveComparison comparison(subject, F, options, false, outcome), of_elements(subject, F, options, true, outcome);
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
        comparison.compare(part, cell_of(of), subject.material, w, unknown);
    comparison.add_rows(part);
    if (!has_elements)
      break;
    for (std::size_t w = 0; w < 2; ++w)
      of_elements.compare(part, cell, subject.material, w, unknown);
    of_elements.add_rows(part);
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
    rows.attempt("one branch", [&] { one_branch(subject, F, options, has_elements, outcome); });
    rows.attempt("orders in kd", [&] { branch_orders(subject, F, rows); });
    if (has_branches(subject.material))
      rows.attempt("own branches", [&] { own_branches(subject, F, options, has_elements, outcome); });
  }
  return outcome;
}

ClaimOutcome check_viscoelastic_waves(const ClaimInput &input)
{
  ViscoelasticWavesOptions options;
  options.states = wave_states(input.subject, input.quick);
  if (!input.quick)
  {
    options.frequencies = {0.03, 0.1, 0.2, 0.4, 0.6, 0.8, 1., 1.25, 1.7, 2.5, 5., 10., 30.};
    options.element_frequencies = {0.1, 0.3, 1., 3., 10.};
    options.element_states = options.states.size();
  }
  ClaimOutcome outcome = viscoelastic_waves_claim(input.subject, options);
  if (!input.subject.is_stable())
    outcome.results.add(stability_row(input.subject, "viscoelastic-waves"));
  return outcome;
}

} // namespace latcon::claims
