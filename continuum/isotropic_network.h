#pragma once

#include "continuum/cauchy_born.h"
#include "continuum/fibres.h"

#include <optional>
#include <vector>

namespace latcon::continuum
{
/// Isotropic law of a fibre network: mean of CauchyBorn over all rotations of the reference configuration, in closed
/// form (theory-continuum.md, eqs. (C.50) to (C.56)). With Mooney-Rivlin rods it is the Mooney-Rivlin law of a network.
/// The mean of custom potentials is a sum over n_directions equally spaced fibres, by which an analytic potential is
/// integrated to round-off: with principal stretches p > q the error falls as ((p - q) / (p + q))^n_directions.
/// It differs from CauchyBorn only in the dependence on direction. The law does not model the thickness.
///
/// The mean depends only on F^T F and is therefore even in det F. As every law it throws for det F < 0: such a state
/// cannot be reached, because the energy of rods with b >= 0 grows without bound as det F -> 0.
class IsotropicNetwork : public Material
{
public:
  /// Creates the law from `families`, whose directions are ignored. Throws InvalidInput as CauchyBorn does.
  explicit IsotropicNetwork(const std::vector<FibreFamily> &families);

  Response evaluate(const dealii::Tensor<2, 2> &F, Order order) const override;

  static constexpr unsigned int n_directions = 96;

private:
  // Sums of weight times constant over the families [Pa]: an energy is linear in its constants.
  double a_ = 0.;
  double b_ = 0.;
  double e_ = 0.;
  std::optional<CauchyBorn> sampled_; // fibres with custom potentials, in all directions
};
} // namespace latcon::continuum
