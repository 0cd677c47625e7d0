#pragma once

#include "continuum/fibres.h"
#include "continuum/material.h"
#include "continuum/plane_invariants.h"

#include <vector>

namespace latcon::continuum
{
/// A network of fibres with all directions alike: the mean of the law CauchyBorn over all rotations of its reference
/// configuration, in closed form (theory-continuum.md, eqs. (C.50) to (C.56)). With Mooney-Rivlin rods it is the
/// Mooney-Rivlin law of a network. Isotropic; what it leaves out of CauchyBorn is the dependence on direction. It knows
/// no thickness: thickness_stretch is 1.
///
/// The mean depends on F^T F alone and is therefore even in det F. det F < 0 is refused as by every law: it is no state
/// of a sheet, and the energy of rods with b >= 0 grows without bound as det F -> 0.
class IsotropicNetwork : public Material
{
public:
  /// The directions of `families` do not matter. Throws InvalidMaterial as CauchyBorn does.
  explicit IsotropicNetwork(const std::vector<FibreFamily> &families);

  double energy(const dealii::Tensor<2, 2> &F) const override;
  dealii::Tensor<2, 2> first_piola_stress(const dealii::Tensor<2, 2> &F) const override;
  dealii::Tensor<4, 2> tangent(const dealii::Tensor<2, 2> &F) const override;
  double thickness_stretch(const dealii::Tensor<2, 2> &F) const override;

private:
  InvariantFunction density(const dealii::Tensor<2, 2> &F) const;

  // Sums of weight times constant over the families [Pa]: an energy is linear in its constants.
  double a_ = 0.;
  double b_ = 0.;
  double e_ = 0.;
};
} // namespace latcon::continuum
