#include "verification/claims/nonlocal/nonlocal_claim.h"

#include <cmath>

#include "support/largest_error.h"
#include "verification/bridge/anisotropy.h"
#include "verification/bridge/plane_waves.h"
#include "verification/bridge/nonlocal_continuum.h"
#include "verification/claims/order_fit.h"

namespace latcon::claims
{
namespace
{

const std::vector<double> middle_ms{2., 4., 8.}; // m
constexpr int grids_per_middle = 16;           // of each kind, from 0.87 to 1.15 of the middle
constexpr double ring_kd = 0.25, cut_stretch = 2.;

enum RingQuantity
{
  of_energy,
  of_stress,
  of_waves,
  of_length,
  of_cut,
  n_ring_quantities
};
using RingErrors = std::array<double, n_ring_quantities>;

// The exact values, and the errors that a stencil makes in them.
class RingLimit
{
public:
  explicit RingLimit(const bridge::Subject &subject)
    : subject_(subject), energy_(subject.network.energy(bridge::to_continuum(F_))),
      stress_(bridge::to_lattice(subject.network.first_piola_stress(bridge::to_continuum(F_)))),
      K_(ring_kd / subject.spacing * Eigen::Vector2d(0.8, 0.6))
  {
    waves_ = bridge::rotation_mean(bridge::rotated_bloch_stiffness(subject.sheet(),
                                                                   lattice::without_dashpots(subject.material),
                                                                   Eigen::Matrix2d::Identity(), K_))
               .mean;
  }

  RingErrors errors(const std::vector<lattice::HalfBond> &stencil, const lattice::Grid &grid) const
  {
    const bridge::NonlocalContinuum sums(stencil, subject_.material, subject_.spacing);
    const double squared_length = bridge::ring_squared_length(subject_.material, subject_.spacing, grid).limit,
                 cut_energy =
                   bridge::ring_cut_energy(subject_.material, subject_.spacing, grid, cut_stretch).limit;
    const Eigen::Matrix2d I = Eigen::Matrix2d::Identity();
    return {sums.energy(F_) / energy_ - 1., (sums.first_piola_stress(F_) - stress_).norm() / stress_.norm(),
            (sums.wave_stiffness(I, K_).reshaped() - waves_).norm() / waves_.norm(),
            sums.squared_length() / squared_length - 1., sums.cut_energy(cut_stretch) / cut_energy - 1.};
  }

private:
  const bridge::Subject &subject_;
  Eigen::Matrix2d F_ = Eigen::Vector2d(1.6, 1.2).asDiagonal();
  double energy_;
  Eigen::Matrix2d stress_;
  Eigen::Vector2d K_;
  Eigen::VectorXd waves_;
};

} // namespace

void ring_convergence(const bridge::Subject &subject, const NonlocalOptions &options, const Rows &rows)
{
  const RingLimit limit(subject);
  std::array<std::vector<double>, n_ring_quantities> rms;
  for (const double middle : middle_ms)
  {
    RingErrors squares{};
    for (const auto kind : {lattice::Grid::Kind::square, lattice::Grid::Kind::triangular})
      for (int i = 0; i < grids_per_middle; ++i)
      {
        const double m = middle * (0.87 + 0.28 * i / (grids_per_middle - 1));
        const lattice::Grid grid{kind, subject.spacing / m, 0., subject.orientation};
        const RingErrors errors = limit.errors(planted_bonds(subject, grid, options), grid);
        for (std::size_t q = 0; q < n_ring_quantities; ++q)
          squares[q] += errors[q] * errors[q] / (2. * grids_per_middle);
      }
    for (std::size_t q = 0; q < n_ring_quantities; ++q)
      rms[q].push_back(std::sqrt(squares[q]));
  }
  const std::string over = ", rms of 32 grids about each of m = 2, 4, 8";
  const auto add_second = [&](const std::string &of, RingQuantity quantity)
  {
    const double order = fitted_order(middle_ms, rms[quantity]);
    rows.add("order in 1/m of the error of " + of + over, "1", of_continuum(-order, 2.), std::abs(order + 2.),
             {0.2, "the term of order 2 is known; the scatter, of order 3/2, is half of it at m = 8 and a quarter at "
                   "m = 2: 0.1, twice"});
  };
  add_second("waves at kd = 0.25, F = I, against the mean over rotations of the lattice", of_waves);
  add_second("the squared intrinsic length against that of the rings", of_length);
  add_second("the energy of a cut against that of the rings", of_cut);
  const auto add_half = [&](const std::string &of, RingQuantity quantity)
  {
    const double order = -fitted_order(middle_ms, rms[quantity]);
    rows.add("order in 1/m of the error of " + of + " at F = (1.6, 1.2) against the network" + over +
               "; error: what is missing to 1/2",
             "1", of_continuum(order, 0.5), support::one_sided(0.5 - order),
             {0.2, "the error is scatter alone, whose rms over 32 grids is known to a fifth: 0.2 over ln 4, rounded up"});
  };
  add_half("the energy density", of_energy);
  add_half("the stress", of_stress);
}

} // namespace latcon::claims
