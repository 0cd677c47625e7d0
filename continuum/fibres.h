#pragma once

#include <deal.II/base/tensor.h>

#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace latcon::continuum
{
/// Energy of an incompressible Mooney-Rivlin rod at stretch l [-] (theory-continuum.md, eq. (C.12)):
///   psi = a (l^2/2 + 1/l - 3/2) + b (l + 1/(2 l^2) - 3/2)    [Pa], with a, b [Pa] and a + b > 0.
struct RodPotential
{
  double a;
  double b;
  friend bool operator==(const RodPotential &p, const RodPotential &q) { return p.a == q.a && p.b == q.b; }
};

/// Energy of a linear spring at stretch l [-]: psi = (e/2) (l - 1)^2 [Pa], with e [Pa] > 0.
struct LinearPotential
{
  double e;
  friend bool operator==(const LinearPotential &p, const LinearPotential &q) { return p.e == q.e; }
};

/// Value [Pa] of psi and its derivatives [Pa] by the stretch.
struct PotentialDerivatives
{
  double value;
  double first;
  double second;
  double third;
  double fourth;
};

/// Potential that is not in closed form here: derive from it.
class CustomPotentialLaw
{
public:
  virtual ~CustomPotentialLaw() = default;

  /// Returns psi(l) and its first four derivatives at stretch l > 0 [-]; NaN where there are none.
  virtual PotentialDerivatives derivatives(double l) const = 0;
};

/// A user-defined potential. Two are equal if they have the same law.
struct CustomPotential
{
  std::shared_ptr<const CustomPotentialLaw> law;
  friend bool operator==(const CustomPotential &p, const CustomPotential &q) { return p.law == q.law; }
};

/// Potential of a fibre. To add a potential, add an alternative here and an overload in fibres.cc.
using FibrePotential = std::variant<RodPotential, LinearPotential, CustomPotential>;

/// Family of fibres with one reference direction.
struct FibreFamily
{
  dealii::Tensor<1, 2> direction; ///< unit vector N_J [-], reference configuration
  double weight;                  ///< c [-] > 0
  FibrePotential potential;       ///< psi [Pa]
};

/// Returns n unit vectors that are equally spaced over half a turn, the first along X_1.
std::vector<dealii::Tensor<1, 2>> directions(unsigned int n);

/// Returns psi(l) and its first four derivatives at stretch l > 0 [-] (theory-continuum.md, eqs. (C.12), (C.13)).
PotentialDerivatives derivatives(const FibrePotential &potential, double l);

/// Checks what `name` has as a family of fibres. Throws InvalidInput unless the direction is a unit vector to 1e-12,
/// and the weight is positive and finite.
void check_fibre(const dealii::Tensor<1, 2> &direction, double weight, const std::string &name);

/// Checks a family. Throws InvalidInput unless the direction is a unit vector to 1e-12, the weight is positive, the
/// stiffness psi''(1) is positive, and all are finite.
void check(const FibreFamily &family);
} // namespace latcon::continuum
