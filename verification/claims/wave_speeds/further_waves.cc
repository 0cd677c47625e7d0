#include "verification/claims/wave_speeds/wave_speeds_claim.h"

#include <cmath>

#include "lattice/end_loads.h"
#include "lattice/simulation.h"
#include "lattice/time_step.h"
#include "support/dense.h"
#include "support/largest_error.h"
#include "verification/bridge/homogeneous_response.h"
#include "verification/bridge/plane_waves.h"
#include "verification/claims/lattice_waves.h"
#include "verification/claims/order_fit.h"
#include "verification/claims/states.h"

namespace latcon::claims
{
namespace
{

// Squares of speeds: twice the tolerance of the lattice's own gradient continuum (wave_speeds_claim.cc).
constexpr double kd_of_speeds = 0.25;
constexpr double matrix_tolerance = 2e-4;

constexpr double width = 8., distance = 6. * width; // of the pulse, and of the end from it [d]

// Integral of the displacement along a polarisation, after the pulse has met the right end, over that before.
double reflected_share(const bridge::Subject &subject, const Eigen::Vector2d &polarisation)
{
  const double d = subject.spacing;
  const Eigen::Matrix2d &F = subject.deformation;
  const lattice::Material material = lattice::without_dashpots(subject.material);
  const lattice::TriangularLattice sheet(d, 2. * distance * d, 8. * d, subject.orientation, {false, true});
  const double speed =
    std::sqrt(polarisation.dot(lattice::tangent_along_x(sheet, material, F) * polarisation) / material.density);
  lattice::State state = lattice::homogeneous_state(sheet, material, F, {false, false, true, true});
  const lattice::State at_rest = state;
  lattice::VectorField velocity(sheet.n_places());
  const double amplitude = 1e-5 * width * d, middle = sheet.length() - distance * d;
  for (std::size_t place = 0; place < sheet.n_places(); ++place)
  {
    const double z = (sheet.reference(place).x() - middle) / (width * d);
    const double u = amplitude * std::exp(-0.5 * z * z), v = speed * z / (width * d) * u;
    state.position.add(place, u * polarisation);
    velocity.set(place, v * polarisation);
  }
  const auto integral = [&](const lattice::State &now)
  {
    double sum = 0.;
    for (std::size_t place = 0; place < sheet.n_places(); ++place)
      if (now.inverse_mass[place] > 0.)
        sum += polarisation.dot(now.position.at(place) - at_rest.position.at(place));
    return sum;
  };
  const double before = integral(state);
  const Eigen::Matrix2d impedance = lattice::end_impedance(sheet, material, F);
  const double limit =
    lattice::time_step_limits(sheet, material, 0.99 * smallest_stretch(sheet, F), {}, impedance).combined;
  lattice::Simulation simulation(sheet, material, std::move(state), 0.9 * limit);
  simulation.load_ends(F, lattice::EndLoads::End::absorbing, lattice::EndLoads::End::absorbing);
  simulation.set_velocities(velocity);
  while (simulation.state().time < 2. * distance * d / speed)
    simulation.step();
  return integral(simulation.state()) / before;
}

} // namespace

void network_waves(const bridge::Subject &subject, const Eigen::Matrix2d &F, const WaveMesh &mesh,
                   ClaimOutcome &outcome)
{
  const double d = subject.spacing, largest = gradient_remainder(subject) * matrix_tolerance;
  const lattice::Material material = lattice::without_dashpots(subject.material);
  const lattice::TriangularLattice sheet = subject.sheet();
  const SubjectContinua media(subject);
  const WaveContinuum &gradient = media.network_gradient;
  const auto on_lattice = [&](const Eigen::Vector2d &K)
  { return bridge::rotated_bloch_stiffness(sheet, material, F, K); };

  support::LargestError from_mean, elements_error;
  CommonOrder local_order, gradient_order;
  for (const double degrees : {0., 15., 40., 75.})
  {
    const Eigen::Vector2d N(std::cos(degrees * M_PI / 180.), std::sin(degrees * M_PI / 180.));
    for (std::size_t i = 0; i < order_kd.size(); ++i)
    {
      const Eigen::Vector2d K = order_kd[i] / d * N;
      const Eigen::VectorXd mean = bridge::rotation_mean(on_lattice(K)).mean;
      local_order.add(i, continuum_matrices(media.network, F, K).stiffness.reshaped(), mean);
      gradient_order.add(i, continuum_matrices(gradient, F, K).stiffness.reshaped(), mean);
    }

    const Eigen::Vector2d K = kd_of_speeds / d * N;
    const Eigen::VectorXd mean = bridge::rotation_mean(on_lattice(K)).mean;
    from_mean.add((continuum_matrices(gradient, F, K).stiffness.reshaped() - mean).norm() / mean.norm());

    const auto closed = continuum_waves(gradient, F, K);
    const auto elements = discrete_waves(gradient, F, K, mesh);
    for (std::size_t w = 0; w < 2; ++w)
      elements_error.add_relative(elements[w].frequency, closed[w].frequency);
  }

  const Rows rows(outcome.results, "wave-speeds", subject.name + ", " + state_name(F) + ": ");
  const bool is_judged = subject.judges(bridge::Law::mooney_rivlin_network),
             gradient_is_judged = subject.judges_network_gradient(F);
  rows.add(
    "matrix of waves at kd = 0.25, network with gradient energy against the lattice's mean over rotations, worst of 4 "
    "directions",
    "1", {}, from_mean, {largest, "squares of speeds: twice what wave-speeds allows at kd = 0.25"}, gradient_is_judged);
  add_order(rows, "order in kd of the local network's error against that mean", local_order, 2., is_judged);
  add_order(rows, "order in kd of the network's error with gradient energy against that mean", gradient_order, 4.,
            gradient_is_judged);
  rows.add("frequency, finite elements of the network with gradient energy against their continuum, worst of all waves",
           "1", {}, elements_error, {discretisation_bound(mesh), "Ainsworth's dispersion error of the elements"},
           is_judged);
}

output::Results absorbing_end_rows(const bridge::Subject &subject)
{
  output::Results results;
  const Rows rows(results, "wave-speeds",
                  subject.name + ", loaded: share of a long wave that an absorbing end reflects, ");
  const support::SymmetricModes waves =
    support::symmetric_modes(lattice::tangent_along_x(subject.sheet(), subject.material, subject.deformation));
  for (int i = 0; i < 2; ++i)
  {
    const double share = reflected_share(subject, waves.vectors.col(i));
    rows.add(i == 0 ? "slower wave" : "faster wave", "1", of_lattice(share, 0.), std::abs(share),
             {5e-4, "dispersion of the pulse, (kd)^2 / 24 at k = 1 / 8 d"});
  }
  return results;
}

} // namespace latcon::claims
