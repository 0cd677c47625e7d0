#include "verification/claims/nonlocal/nonlocal_claim.h"

#include <algorithm>
#include <cmath>

#include "lattice/time_step.h"
#include "support/largest_error.h"
#include "verification/bridge/nonlocal_continuum.h"
#include "verification/bridge/plane_waves.h"
#include "verification/claims/claim_list.h"
#include "verification/claims/continuum_waves.h"
#include "verification/claims/states.h"

namespace latcon::claims
{
namespace
{

const output::Tolerance equal_sums{1e-10,
                                   "a few thousand round-offs of the largest term of sums over at most 127 half-bonds"};
const output::Tolerance share_of_bound{
  1., "the bound: harmonics of a bond's share from the sixth on, since weights are positive and lower moments exact"};

const output::Tolerance balanced{
  0.02, "a third of what weights without balance leave, so that stretches of bonds at rest differ by 2 % and less"};

constexpr double stencil_wave_degrees[] = {0., 15., 40., 75.};
constexpr double stencil_wave_kd = 0.25, long_wave_kd = 1e-3;

Eigen::Vector2d vector_of_wave(double k, double angle)
{
  return {k * std::cos(angle), k * std::sin(angle)};
}

// Bound (H.26) on the error of a sum over bonds, `share` being the 1 or 4 values of a bond of a ring with direction N.
template <class Share>
double bound_of_harmonics(const bridge::Subject &subject, int n_values, const Share &share)
{
  double bound = 0.;
  for (const lattice::Ring &ring : bridge::rings_of(subject.material, subject.spacing, subject.orientation))
  {
    Eigen::MatrixXd columns(n_values, bridge::n_bond_directions);
    for (int k = 0; k < bridge::n_bond_directions; ++k)
      columns.col(k) = share(*subject.material.in_shell(ring.shell), ring, bridge::bond_direction(k)).reshaped();
    bound += bridge::ring_weight(subject.material, subject.spacing, ring) * bridge::direction_mean(columns).bound;
  }
  return bound;
}

// Energy density and stress of the network at F, with the bounds on those of any stencil.
struct NetworkAt
{
  double energy, energy_bound;
  Eigen::Matrix2d stress;
  double stress_bound;

  NetworkAt(const bridge::Subject &subject, const Eigen::Matrix2d &F)
    : energy(subject.network.energy(bridge::to_continuum(F))),
      stress(bridge::to_lattice(subject.network.first_piola_stress(bridge::to_continuum(F))))
  {
    const auto energy_of = [&](const lattice::Shell &shell, const lattice::Ring &, const Eigen::Vector2d &N)
    { return Eigen::VectorXd::Constant(1, lattice::energy(shell.law, (F * N).norm())).eval(); };
    const auto stress_of = [&](const lattice::Shell &shell, const lattice::Ring &, const Eigen::Vector2d &N)
    {
      const Eigen::Vector2d n = F * N;
      return Eigen::Matrix2d(lattice::force(shell.law, n.norm()) / n.norm() * n * N.transpose());
    };
    energy_bound = *equal_sums * std::abs(energy) + bound_of_harmonics(subject, 1, energy_of);
    stress_bound = *equal_sums * stress.norm() + bound_of_harmonics(subject, 4, stress_of);
  }
};

// Bound (H.26) on the matrix of waves [1/s^2] of rings without width.
double wave_bound(const bridge::Subject &subject, const Eigen::Matrix2d &F, const Eigen::Vector2d &K)
{
  return bound_of_harmonics(subject, 4,
                            [&](const lattice::Shell &shell, const lattice::Ring &ring, const Eigen::Vector2d &N)
                            {
                              const double l = ring.radius;
                              const double phase =
                                std::pow(2. * std::sin(0.5 * l * K.dot(N)) / l, 2) / subject.material.density;
                              return (phase * bridge::bond_tangent(shell.law, F * N)).eval();
                            });
}

// Squared intrinsic length [m^2] in the dispersion of waves about F = I, from the trace of their matrix for two kd. Its
// mean over directions is 4 c_S^2 k^2 (1 - l^2 k^2 / 16 + O(k^4)).
template <class Stiffness>
double squared_length_of(const bridge::Subject &subject, const Stiffness &stiffness)
{
  const auto at = [&](double k)
  {
    constexpr int n = 8;
    double trace = 0.;
    for (int i = 0; i < n; ++i)
      trace += stiffness(vector_of_wave(k, M_PI * i / n)).trace() / n;
    return 16. / (k * k) * (1. - trace / (4. * std::pow(subject.theory.shear_speed * k, 2)));
  };
  const double k = 0.05 / subject.spacing;
  return (4. * at(k) - at(2. * k)) / 3.;
}

// Rows of one stencil, and the largest errors of several.
class StencilRows
{
public:
  StencilRows(const bridge::Subject &subject, const NonlocalOptions &options) : subject_(subject), options_(options) {}

  void check(const NonlocalStencil &stencil, const Rows &rows)
  {
    const StencilSheet sheet(subject_, stencil.grid,
                             planted_bonds(subject_, stencil.grid, options_, stencil.half_width),
                             options_.planted_factors);
    moduli(sheet);
    homogeneous(sheet, stencil, rows);
    waves(sheet, stencil, rows);
    if (stencil.grid.scatter.amplitude > 0.)
    {
      const Eigen::Matrix2d F = Eigen::Vector2d(2.3, 2.8).asDiagonal();
      rows.add("force on a point at F = (2.3, 2.8) before it moves, rms over the sum of the tensions that meet there",
               "1", {}, sheet.imbalance(F), balanced);
      return;
    }
    // Of the widths of other rings no closed form is known.
    const bool is_known = stencil.half_width > 0.999 * M_PI / 6. && 1.499 * stencil.grid.spacing < subject_.spacing;
    length(sheet, stencil, rows, is_known);
    relaxation(sheet);
    cut(sheet, stencil, rows, is_known);
  }

  void add_worst(const Rows &rows) const
  {
    rows.add("all elastic moduli at F = I, simulator against the network, largest error over mu", "1", {}, moduli_,
             small_strain_tolerance);
    rows.add("energy density and stress at F = (2, 2), where all bonds have one stretch, simulator against the network",
             "1", {}, equal_stretches_, equal_sums);
    const std::string samples = ", " + std::to_string(options_.samples) + " random F";
    rows.add("energy density, simulator against the network, largest error over the bound of harmonics" + samples, "1",
             {}, energy_, share_of_bound);
    rows.add("first Piola stress, simulator against the network, largest error over the bound of harmonics" + samples,
             "1", {}, stress_, share_of_bound);
    rows.add(
      "matrix of waves at kd = 0.25, simulator against the lattice's mean over rotations, largest error over the "
      "bound of harmonics and of the widths of rings, F = I and loaded",
      "1", {}, waves_, share_of_bound);
    if (subject_.is_stable())
      rows.add(
        "squared speeds of long waves in the loaded sheet, simulator against the network, largest error over the "
        "bound of harmonics, 4 directions",
        "1", {}, speeds_, share_of_bound);
    rows.add("energy of a cut along x, simulator against the sum over half-bonds that cross it", "1", {}, cut_,
             equal_sums);
    rows.add("tip of that cut, found by the simulator, behind the cut's end, over the period of the grid", "1", {},
             tip_, {1.02, "points left and right of the end are a period apart, which the end divides 1 : 76"});
    rows.add("stress at F = (1.2, 1.2) while Maxwell branches relax, simulator against the network, error over the "
             "overstress at the start",
             "1", {}, relaxation_, equal_sums);
  }

private:
  void moduli(const StencilSheet &sheet)
  {
    const auto exact = subject_.network.tangent(bridge::to_continuum(Eigen::Matrix2d::Identity()));
    const auto stress = [&](const Eigen::Matrix2d &F) { return sheet.response(F).first_piola_stress; };
    for (int k = 0; k < 2; ++k)
      for (int L = 0; L < 2; ++L)
      {
        const Eigen::Matrix2d found = stress_derivative(stress, k, L);
        for (int i = 0; i < 2; ++i)
          for (int J = 0; J < 2; ++J)
            moduli_.add(std::abs(found(i, J) - exact[i][J][k][L]) / subject_.theory.shear_modulus);
      }
  }

  // Adds a row of the loaded sheet: the stencil of the case must be accurate whatever its bound is.
  static void add_loaded(const NonlocalStencil &stencil, const Rows &rows, const std::string &quantity,
                         const std::string &unit, const Sides &values, double error, double bound)
  {
    constexpr double largest = 0.1;
    rows.add(quantity, unit, values, error, {support::smallest_of({bound, largest}), share_of_bound.reason},
             stencil.is_of_case || bound <= largest);
  }

  void homogeneous(const StencilSheet &sheet, const NonlocalStencil &stencil, const Rows &rows)
  {
    const Eigen::Matrix2d twice = 2. * Eigen::Matrix2d::Identity();
    const NetworkAt equal(subject_, twice);
    const bridge::LatticeResponse at_twice = sheet.response(twice);
    equal_stretches_.add_relative(at_twice.energy_density, equal.energy);
    equal_stretches_.add((at_twice.first_piola_stress - equal.stress).norm() / equal.stress.norm());

    for (const Eigen::Matrix2d &F : random_deformations(options_.samples))
    {
      const NetworkAt network(subject_, F);
      const bridge::LatticeResponse found = sheet.response(F);
      energy_.add(std::abs(found.energy_density - network.energy) / network.energy_bound);
      stress_.add((found.first_piola_stress - network.stress).norm() / network.stress_bound);
    }

    const Eigen::Matrix2d &F = subject_.deformation;
    if (F.isIdentity(1e-12))
      return; // neither stress nor energy
    const NetworkAt network(subject_, F);
    const bridge::LatticeResponse found = sheet.response(F),
                                  on_lattice = bridge::homogeneous_response(subject_.sheet(12.), subject_.material, F);
    add_loaded(stencil, rows, "energy density of the loaded sheet; lattice, nonlocal continuum, network", "J/m^3",
               of_both(on_lattice.energy_density, found.energy_density, network.energy),
               support::relative_error(found.energy_density, network.energy), network.energy_bound / network.energy);
    add_loaded(stencil, rows,
               "first Piola stress of the loaded sheet, Frobenius norm; lattice, nonlocal continuum, network", "Pa",
               of_both(on_lattice.first_piola_stress.norm(), found.first_piola_stress.norm(), network.stress.norm()),
               (found.first_piola_stress - network.stress).norm() / network.stress.norm(),
               network.stress_bound / network.stress.norm());
  }

  void waves(const StencilSheet &sheet, const NonlocalStencil &stencil, const Rows &rows)
  {
    const double d = subject_.spacing, h = stencil.grid.spacing;
    const SubjectContinua media(subject_);
    const lattice::Material elastic = lattice::without_dashpots(subject_.material);
    // The width of a ring lengthens its bonds in the mean of squares, the shortest ring most, see (H.27).
    const double longer = 0.5 * std::pow(h / d, 2) + 0.19 * std::pow(h / d, 1.5);
    std::vector<Eigen::Matrix2d> states{Eigen::Matrix2d::Identity()};
    if (!subject_.deformation.isIdentity(1e-12))
      states.push_back(subject_.deformation);
    for (const Eigen::Matrix2d &F : states)
      for (const double degrees : stencil_wave_degrees)
      {
        const Eigen::Vector2d K = sheet.wave_vector(vector_of_wave(stencil_wave_kd / d, degrees * M_PI / 180.));
        const Eigen::Matrix2d mean =
          bridge::rotation_mean(bridge::rotated_bloch_stiffness(subject_.sheet(), elastic, F, K)).mean.reshaped(2, 2);
        const double of_lengths = (continuum_matrices(media.network, F, K).stiffness - mean).norm();
        waves_.add((sheet.wave_stiffness(F, K) - mean).norm() /
                   (wave_bound(subject_, F, K) + longer * of_lengths + 1e-8 * mean.norm()));
      }
    // Waves between scattered points are not longer than the sheet.
    if (!subject_.is_stable() || stencil.grid.scatter.amplitude > 0.)
      return;
    const Eigen::Matrix2d &F = subject_.deformation;
    for (const double degrees : stencil_wave_degrees)
    {
      const Eigen::Vector2d K = vector_of_wave(long_wave_kd / d, degrees * M_PI / 180.);
      const double k = K.norm(), bound = wave_bound(subject_, F, K);
      const auto network = continuum_waves(media.network, F, K),
                 found =
                   bridge::plane_waves({sheet.wave_stiffness(F, K), Eigen::Matrix2d::Zero()}, network[0].polarisation),
                 on_lattice = bridge::bloch_waves(subject_.sheet(), elastic, F, K);
      if (stencil.is_of_case)
        (void)bridge::fastest_frequency(found); // throws where a wave grows
      for (std::size_t w = 0; w < 2; ++w)
      {
        const double exact = std::pow(network[w].frequency, 2);
        // Terms of order (kd)^2, and of the square of the strain; under tension S may be the faster wave.
        const double allowed = bound + 1e-6 * std::pow(bridge::fastest_frequency(network), 2);
        speeds_.add(std::abs(std::pow(found[w].frequency, 2) - exact) / allowed);
        if (degrees == 0.)
          add_loaded(stencil, rows,
                     "speed of long " + wave_names[w] +
                       " waves along x in the loaded sheet; lattice, nonlocal continuum, network",
                     "m/s", of_both(on_lattice[w].frequency / k, found[w].frequency / k, network[w].frequency / k),
                     support::relative_error(found[w].frequency, network[w].frequency),
                     1. - std::sqrt(1. - support::smallest_of({1., allowed / exact})));
      }
    }
  }

  void length(const StencilSheet &sheet, const NonlocalStencil &stencil, const Rows &rows, bool is_known)
  {
    const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
    const lattice::Material elastic = lattice::without_dashpots(subject_.material);
    const auto of_lattice = [&](const Eigen::Vector2d &K)
    { return bridge::bloch_matrices(subject_.sheet(), elastic, I, K).stiffness; };
    const auto of_stencil = [&](const Eigen::Vector2d &K) { return sheet.wave_stiffness(I, K); };
    const double on_lattice = squared_length_of(subject_, of_lattice), found = squared_length_of(subject_, of_stencil),
                 gradient = 12. * std::pow(subject_.lengths.isotropic_inertia, 2);
    const bridge::RingValue rings = bridge::ring_squared_length(subject_.material, subject_.spacing, stencil.grid);
    rows.add("intrinsic length l in the dispersion of long waves at F = I; lattice, nonlocal continuum, gradient "
             "continuum; error: of l^2 against l^2 + h^2/2 of rings as wide as the spacing h of the grid",
             "m", of_both(std::sqrt(on_lattice), std::sqrt(found), std::sqrt(gradient)),
             std::abs(found - gradient - (rings.smooth - rings.limit)) / rings.limit,
             {rings.scatter / rings.limit, "scatter of the points of the grid in rings, of order (h/l)^(3/2)"},
             is_known);
  }

  void cut(const StencilSheet &sheet, const NonlocalStencil &stencil, const Rows &rows, bool is_known)
  {
    const double stretch = options_.breaking_stretch, d = subject_.spacing;
    const bridge::NonlocalContinuum sums(sheet.half_bonds(), subject_.material, d);
    const StencilSheet::Cut at_stretch = sheet.cut(stretch);
    const double found = at_stretch.energy;
    cut_.add_relative(found, sums.cut_energy(stretch));
    // Above the line of the cut a quarter of all directions lead across it behind a point; a point is the tip if it has
    // lost as much.
    tip_.add(std::abs(at_stretch.tip + options_.planted_tip) / at_stretch.period);
    const lattice::Grid grid{lattice::Grid::Kind::triangular, d, subject_.orientation};
    const bridge::NonlocalContinuum on_lattice(lattice::triangular_stencil(grid), subject_.material, d);
    const bridge::RingValue rings = bridge::ring_cut_energy(subject_.material, d, stencil.grid, stretch);
    rows.add("energy of a straight cut along x through bonds at the breaking stretch; lattice, nonlocal continuum, "
             "rings without width; error: against rings as wide as the spacing h of the grid",
             "J/m^2", of_both(on_lattice.cut_energy(stretch), found, rings.limit),
             std::abs(found - rings.smooth) / rings.limit,
             {rings.scatter / rings.limit, "scatter of the points of the grid in rings, of order (h/l)^(3/2)"},
             is_known);
  }

  // Bonds have one stretch, so that the sum over rings is a closed form.
  void relaxation(const StencilSheet &sheet)
  {
    constexpr double stretch = 1.2;
    constexpr std::size_t n_steps = 40;
    const lattice::Material elastic = lattice::without_dashpots(subject_.material);
    const double step = 0.5 * lattice::time_step_limits(sheet.sheet(), elastic, 1.).combined;
    const lattice::Material material = with_branches(elastic, {0.5, 0.2}, {20. * step, 60. * step});
    double relaxed = 0., at_start = 0.; // stress of the branches
    for (const lattice::Ring &ring : bridge::rings_of(subject_.material, subject_.spacing, subject_.orientation))
      for (const auto &branch : std::get<lattice::MaxwellMemory>(material.in_shell(ring.shell)->memory).branches())
      {
        const double stress =
          0.5 * bridge::ring_weight(subject_.material, subject_.spacing, ring) * branch.modulus * (stretch - 1.);
        at_start += stress;
        relaxed += stress * std::exp(-static_cast<double>(n_steps) * step / branch.relaxation_time);
      }
    const Eigen::Matrix2d I = Eigen::Matrix2d::Identity(), F = stretch * I;
    const lattice::Material simulated = options_.planted_branches(material);
    relaxation_.add(
      (sheet.relaxed_stress(simulated, F, step, n_steps) - NetworkAt(subject_, F).stress - relaxed * I).norm() /
      (at_start * I).norm());
  }

  const bridge::Subject &subject_;
  const NonlocalOptions &options_;
  support::LargestError moduli_, equal_stretches_, energy_, stress_, waves_, speeds_, cut_, tip_, relaxation_;
};

} // namespace

std::vector<NonlocalStencil> fixed_stencils(const bridge::Subject &subject)
{
  std::vector<NonlocalStencil> list;
  for (const auto &[kind, name] :
       {std::pair(lattice::Grid::Kind::square, "square"), std::pair(lattice::Grid::Kind::triangular, "triangular")})
    for (const auto &[m, text] : {std::pair(1.5, "1.5"), std::pair(2., "2"), std::pair(3., "3")})
      list.push_back({std::string(name) + " grid, m = " + text, {kind, subject.spacing / m, subject.orientation}});
  const bool is_coarse = subject.material.third_nearest.has_value(); // finer points would have too many bonds
  lattice::Grid square = list[0].grid, triangular = list[is_coarse ? 3 : 4].grid;
  square.scatter = triangular.scatter = {0.5, 1};
  list.push_back({"scattered points of a square grid, m = 1.5", square});
  list.push_back({"scattered points of a triangular grid, m = " + std::string(is_coarse ? "1.5" : "2"), triangular});
  return list;
}

output::Results nonlocal_claim(const bridge::Subject &subject, const NonlocalOptions &options)
{
  output::Results results;
  const Rows rows(results, "nonlocal", subject.name + ": ");
  StencilRows of_stencils(subject, options);
  bool all = true;
  for (const NonlocalStencil &stencil : options.stencils)
    all = rows.attempt(stencil.name, [&] { of_stencils.check(stencil, rows.about(stencil.name + ", ")); }) && all;
  if (all)
    of_stencils.add_worst(rows.about("worst stencil, "));
  rows.attempt("convergence", [&] { ring_convergence(subject, options, rows); });
  return results;
}

ClaimOutcome check_nonlocal(const ClaimInput &input)
{
  const bridge::Subject &subject = input.subject;
  NonlocalOptions options;
  options.stencils = fixed_stencils(subject);
  const input::NonlocalCase &own = input.entries.nonlocal;
  const auto is_own = [&](const NonlocalStencil &fixed)
  {
    return fixed.grid.kind == own.grid && fixed.half_width <= own.half_width &&
           fixed.grid.scatter.amplitude == own.scatter &&
           std::abs(fixed.grid.spacing * own.refinement / subject.spacing - 1.) < 1e-12;
  };
  const bool has_shells_of_case = subject.material.next_nearest.has_value() == input.entries.has_next_nearest;
  for (NonlocalStencil &stencil : options.stencils)
    stencil.is_of_case = has_shells_of_case && is_own(stencil);
  if (std::none_of(options.stencils.begin(), options.stencils.end(), is_own))
    options.stencils.push_back({"stencil of the case",
                                {own.grid, subject.spacing / own.refinement, subject.orientation, {own.scatter, 1}},
                                support::smallest_of({own.half_width, M_PI / 6.}),
                                has_shells_of_case});
  options.samples = input.quick ? 10 : 100;
  options.breaking_stretch = input.entries.breaking_stretch.value_or(options.breaking_stretch);
  ClaimOutcome outcome{nonlocal_claim(subject, options), {}};
  if (!subject.is_stable())
    outcome.results.add(stability_row(subject, "nonlocal"));
  return outcome;
}

} // namespace latcon::claims
