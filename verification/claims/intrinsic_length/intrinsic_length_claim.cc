#include "verification/claims/intrinsic_length/intrinsic_length_claim.h"

#include <cmath>

#include "support/largest_error.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/states.h"

namespace latcon::claims
{
namespace
{

const output::Tolerance bloch_tolerance{
  1e-7, "extrapolation of Bloch's frequencies to kd = 0 (bloch_alpha): 84 (kd)^4 (l/d)^6 / 20160 at kd = 0.02"};
const output::Tolerance equal_closed_forms{1e-10, "two closed forms of the same number"};
const output::Tolerance sign{0., "a sign"};
const output::Tolerance positive{1e-12, "round-off of an eigenvalue that may be zero"};

// alpha at F = I: its dependence on direction, from Bloch, from runs, in the continua.
void dispersion(const bridge::Subject &subject, double angle_step, const Rows &rows, ClaimOutcome &outcome)
{
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  const lattice::TriangularLattice sheet = subject.sheet();
  const lattice::Material material = lattice::without_dashpots(subject.material);
  const double d = subject.spacing;
  const SubjectContinua media(subject);

  // All directions.
  output::Table &table = outcome.table("dispersion", {"shells", "angle [deg]", "alpha_L", "alpha_S", "nearest_L",
                                                      "nearest_S", "isotropic_L", "isotropic_S"});
  support::LargestError bloch_error, continuum_error;
  support::Extremes alphas;
  std::array<support::LargestError, 2> isotropic_loss;
  std::array<support::LargestError, 2> network_loss;
  std::vector<Alpha> of_network;
  Alpha mean{}, isotropic_alpha{}, nearest_mean{};
  const auto n_angles = static_cast<int>(std::lround(180. / angle_step));
  for (int i = 0; i <= n_angles; ++i)
  {
    const double degrees = 180. * i / n_angles, radians = degrees * M_PI / 180.;
    const Eigen::Vector2d N(std::cos(radians), std::sin(radians));
    Alpha nearest{};
    const Alpha closed = lattice_alpha(sheet, material, I, N, &nearest), bloch = bloch_alpha(sheet, material, I, N),
                continuum = continuum_alpha(media.gradient, I, N, d);
    isotropic_alpha = continuum_alpha(media.isotropic, I, N, d);
    of_network.push_back(continuum_alpha(media.network_gradient, I, N, d));
    for (std::size_t w = 0; w < 2; ++w)
    {
      bloch_error.add_difference(bloch[w], closed[w]);
      continuum_error.add_difference(continuum[w], closed[w]);
      alphas.add(bloch[w]);
      isotropic_loss[w].add_difference(isotropic_alpha[w], closed[w]);
      network_loss[w].add_difference(of_network.back()[w], closed[w]);
      if (i < n_angles) // 180 degrees are 0 degrees
      {
        mean[w] += closed[w] / n_angles;
        nearest_mean[w] += nearest[w] / n_angles;
      }
    }
    table.add(
      {subject.name, degrees, bloch[0], bloch[1], nearest[0], nearest[1], isotropic_alpha[0], isotropic_alpha[1]});
  }

  // Directions in which waves are run.
  const output::Tolerance run_tolerance{
    subject.material.third_nearest ? 1.6e-5 : 1e-5,
    "fourth term of the series of w(k), left out of the fit to four waves: 2.4e-6, with third-nearest neighbours "
    "7.6e-6; errors of the waves, 2e-7, times twenty; half of both for a margin"};
  output::Table &runs = outcome.table("dispersion_runs", {"shells", "angle [deg]", "alpha_L", "alpha_S"});
  for (const WaveDirection &direction : wave_directions(subject.orientation))
  {
    const Eigen::Vector2d N = unit_vector(direction, subject.orientation);
    const double degrees = angle(direction, subject.orientation);
    const std::string at = " at " + std::to_string(std::lround(degrees)) + " degrees";
    Alpha run{unknown, unknown}; // if no wave oscillates, the rows fail
    rows.attempt("lattice run, waves" + at,
                 [&] { run = running_alpha(d, subject.orientation, direction, material, I); });
    runs.add({subject.name, degrees, run[0], run[1]});
    const Alpha closed = lattice_alpha(sheet, material, I, N), continuum = continuum_alpha(media.gradient, I, N, d);
    for (std::size_t w = 0; w < 2; ++w)
      rows.add("alpha of " + wave_names[w] + " waves" + at + ", lattice run against closed form", "1",
               of_both(run[w], continuum[w], closed[w]), std::abs(run[w] - closed[w]), run_tolerance);
  }

  rows.add("alpha in all directions, Bloch against closed form", "1", {}, bloch_error, bloch_tolerance);
  rows.add("alpha in all directions, gradient continuum against closed form", "1", {}, continuum_error,
           equal_closed_forms);
  // A positive alpha softens; the claim is the sign.
  rows.add("softening: smallest alpha of any wave", "1", of_lattice(alphas.smallest()),
           support::one_sided(-alphas.smallest()), sign);
  rows.add("largest alpha of any wave", "1", of_lattice(alphas.largest()));
  for (std::size_t w = 0; w < 2; ++w)
  {
    const std::string name = "alpha of " + wave_names[w] + " waves, ";
    rows.add(name + "mean over directions, isotropic gradient continuum against lattice", "1",
             of_both(mean[w], isotropic_alpha[w]), std::abs(isotropic_alpha[w] - mean[w]), equal_closed_forms,
             subject.judges(bridge::Law::isotropic_gradient));
    rows.add(name + "largest difference of the isotropic continuum from the lattice", "1", {}, isotropic_loss[w]);
    // At F = I its moduli are the lattice's, so the mean of its gradient energy gives the mean of alpha, in all
    // directions.
    support::LargestError from_mean;
    for (const Alpha &alpha : of_network)
      from_mean.add_difference(alpha[w], mean[w]);
    rows.add(name + "network in all directions against the lattice's mean over directions", "1",
             of_both(mean[w], from_mean.value()), from_mean, equal_closed_forms,
             subject.judges(bridge::Law::mooney_rivlin_network));
    rows.add(name + "largest difference of the network from the lattice", "1", {}, network_loss[w]);
    if (subject.material.third_nearest || subject.material.next_nearest)
      rows.add(name + "mean over directions, the part of the " +
                 (subject.material.third_nearest ? "longer" : "next-nearest") + " bonds",
               "1", of_lattice(mean[w] - nearest_mean[w]));
  }
  const WaveContinuum no_inertia{media.isotropic.constitution, {subject.material.density, 0.}};
  const Alpha hardening = continuum_alpha(no_inertia, I, Eigen::Vector2d(1., 0.), d);
  // Not a fault of the code: a positive gradient energy alone cannot soften.
  const double least_hardening = support::largest_of({hardening[0], hardening[1]});
  rows.add("hardening: alpha of a positive gradient energy without micro-inertia is negative", "1",
           of_continuum(least_hardening), support::one_sided(least_hardening), sign,
           subject.judges(bridge::Law::isotropic_gradient));
}

// The length that keeps the gradient energy positive.
void positivity(const bridge::Subject &subject, const Rows &rows)
{
  const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
  const lattice::TriangularLattice sheet = subject.sheet();
  const double d = subject.spacing, unit = subject.theory.shear_modulus * d * d;
  const double longest = subject.material.third_nearest  ? 2. * d
                         : subject.material.next_nearest ? std::sqrt(3.) * d
                                                         : d;
  const double length = longest / std::sqrt(12.);
  rows.add("intrinsic length l_d, the longest bond over sqrt(12)", "m",
           of_both(length, subject.lengths.lattice, length), support::relative_error(subject.lengths.lattice, length),
           equal_closed_forms);

  for (const auto &[name, F] : {std::pair("F = I", I), std::pair("loaded", subject.deformation)})
  {
    const std::string where = std::string(", ") + name;
    const std::optional<double> critical = critical_length(sheet, subject.material, F);
    // Positive at l_d: no shorter length than the critical one.
    const std::string shortest = "shortest length with a positive gradient energy, against l_d" + where;
    if (critical)
      rows.add(shortest, "m", of_both(*critical, subject.lengths.lattice),
               support::one_sided(*critical / subject.lengths.lattice - 1.), equal_closed_forms,
               subject.judges_gradient(F));
    else
      // See judges_gradient(): the law neglects the terms that make it negative.
      rows.add(shortest + ": there is none, bonds are compressed", "m", of_continuum(subject.lengths.lattice));
    const double at_length = smallest_eigenvalue(*subject.lattice_gradient, F) / unit;
    rows.add("smallest eigenvalue of the gradient energy over mu d^2 at l_d" + where, "1", of_continuum(at_length),
             support::one_sided(-at_length), positive);
    const double of_network = smallest_eigenvalue(*subject.network_gradient, F) / unit;
    rows.add("smallest eigenvalue of the network's gradient energy over mu d^2 at l_d" + where, "1",
             of_continuum(of_network), support::one_sided(-of_network), positive,
             subject.judges(bridge::Law::mooney_rivlin_network));
    if (!critical)
      continue;
    const double below = smallest_lattice_eigenvalue(sheet, subject.material, F, 0.99 * *critical) / unit;
    rows.add("the same 1 % below the shortest length: negative" + where, "1", of_lattice(below),
             support::one_sided(below), sign);
  }
}

// A free edge, its rows along x.
void edge_layer(const bridge::Subject &subject, const Rows &rows, ClaimOutcome &outcome)
{
  constexpr double stretch = 1.05; // along the edge [-]
  constexpr std::size_t n_rows = 12;
  const lattice::Material material = lattice::without_dashpots(subject.material);
  // Without an equilibrium the rows fail.
  EdgeLayer layer{unknown, std::vector<double>(n_rows, unknown), unknown};
  rows.attempt("edge layer, relaxed strip", [&] { layer = relaxed_edge(subject.spacing, material, stretch, n_rows); });
  const double root = edge_decay(subject.spacing, material, stretch, layer.stretch_across);
  // Linear from the third spacing on, where the deviation is below 1e-3; anchored there.
  constexpr std::size_t anchor = 2;
  output::Table &table = outcome.table("edge_layer", {"shells", "row", "deviation", "theory"});
  for (std::size_t j = 0; j < layer.deviations.size(); ++j)
    table.add(
      {subject.name, static_cast<double>(j + 1), layer.deviations[j],
       !material.next_nearest ? 0. : layer.deviations[anchor] * std::pow(root, static_cast<double>(j) - anchor)});

  rows.add("edge layer: residual force of the relaxed strip over mu d", "1",
           of_lattice(layer.residual / (subject.theory.shear_modulus * subject.spacing)));
  if (!subject.material.next_nearest)
  {
    support::LargestError largest;
    for (const double deviation : layer.deviations)
      largest.add_difference(deviation, 0.);
    // Statics of nearest neighbours have no length: every row interacts with the next one only. Third-nearest bonds
    // between rows are collinear with nearest ones: both have the same stretch, 1 at a free edge, and neither pulls.
    rows.add("no edge layer: largest deviation of a row spacing at a free edge", "1", of_lattice(largest.error(), 0.),
             largest, {1e-10, "residual of the relaxed strip"});
    return;
  }
  rows.add("edge layer: deviation of the first row spacing, stretch 1.05", "1", of_lattice(layer.deviations[0]));
  // Rows four to seven, where the second power of the deviation is gone, or earlier ones of a layer that decays faster:
  // those before round-off, which is 1e-12.
  std::size_t last = 6;
  while (last > 0 && std::abs(layer.deviations[last]) < 5e-9)
    --last;
  if (last == 0)
    return;
  const std::size_t first = last > 3 ? 3 : last - 1;
  const double decay =
    -std::pow(std::abs(layer.deviations[last] / layer.deviations[first]), 1. / static_cast<double>(last - first));
  const bool alternates = layer.deviations[first] * layer.deviations[first + 1] < 0.;
  const double factor = alternates ? decay : -decay;
  rows.add(
    "edge layer: decay from row to row, against its characteristic equation", "1", of_lattice(factor, root),
    support::relative_error(factor, root),
    output::limited(10. * std::abs(layer.deviations[first]) + 1e-12 / std::abs(layer.deviations[last]), 1e-5, 1e-3,
                    "terms of second order: deviation of the fourth row, or an earlier one, times third over second "
                    "moduli, up to 10; round-off of the last row"));
  // Layer of a continuum with that gradient energy: exp(-Y / l), of one sign.
  const WaveContinuum gradient{{subject.cauchy_born, *subject.lattice_gradient}, {subject.material.density, 0.}};
  const Eigen::Matrix2d F = Eigen::Vector2d(stretch, layer.stretch_across).asDiagonal();
  const Alpha alpha = continuum_alpha(gradient, F, Eigen::Vector2d(0., 1.), subject.spacing);
  rows.add("edge layer: decay factor per row, gradient continuum (always positive)", "1",
           of_both(factor, std::exp(-std::sqrt(3.) / 2. / std::sqrt(-alpha[0]))));
}

} // namespace

ClaimOutcome intrinsic_length_claim(const bridge::Subject &subject, double angle_step)
{
  ClaimOutcome outcome;
  const Rows rows(outcome.results, "intrinsic-length", subject.name + ": ");
  rows.attempt("alpha", [&] { dispersion(subject, angle_step, rows, outcome); });
  rows.attempt("positive gradient energy", [&] { positivity(subject, rows); });
  rows.attempt("edge layer", [&] { edge_layer(subject, rows, outcome); });
  return outcome;
}

ClaimOutcome check_intrinsic_length(const ClaimInput &input)
{
  return intrinsic_length_claim(input.subject, input.quick ? 15. : 3.);
}

} // namespace latcon::claims
