#include "continuum/flank.h"

#include "continuum/cauchy_born.h"

#include <algorithm>
#include <cmath>
#include <optional>

using namespace dealii;

namespace latcon::continuum
{
namespace
{
// A law less half of the energy of some bonds.
class LessBonds : public Material
{
public:
  explicit LessBonds(const Material &whole, std::optional<CauchyBorn> bonds = {})
    : whole_(whole), bonds_(std::move(bonds))
  {
  }
  Response evaluate(const Tensor<2, 2> &F, Order order) const override
  {
    Response W = whole_.evaluate(F, order);
    if (!bonds_)
      return W;
    const Response cut = bonds_->evaluate(F, order);
    W.energy -= 0.5 * cut.energy;
    W.first_piola -= 0.5 * cut.first_piola;
    W.tangent -= 0.5 * cut.tangent;
    return W;
  }

private:
  const Material &whole_;
  std::optional<CauchyBorn> bonds_;
};

// The law of a whole sheet, with those of the layers of a flank.
template <class Interface, class Law>
class Layered : public Law
{
public:
  Layered(const Law &whole, std::shared_ptr<const Flank::Layers> layers) : Law(whole), layers_(std::move(layers)) {}
  const Interface &at(const Point<2> &X) const override
  {
    const std::size_t layer = layers_->at(X);
    return layer < laws.size() ? laws[layer] : *this;
  }
  std::vector<Law> laws;

private:
  std::shared_ptr<const Flank::Layers> layers_;
};
using LayeredMaterial = Layered<Material, LessBonds>;
using LayeredViscosity = Layered<Viscosity, FibreViscosity>;
} // namespace

std::size_t Flank::Layers::at(const Point<2> &X) const
{
  if (!(X[0] > start && X[0] < tip))
    return depths.size();
  return std::upper_bound(depths.begin(), depths.end(), X[1] - axis) - depths.begin();
}

Flank::Flank(double axis, double start, double pitch, const std::vector<BondFamily> &bonds, const Material &whole,
             const Viscosity *viscosity)
  : layers_(std::make_shared<Layers>(Layers{axis, start, start, {}}))
{
  // A bond reaches a whole number of lines of sites.
  const auto lines = [pitch](const Tensor<1, 2> &direction, double length)
  { return std::lround(std::abs(direction[1]) * length / pitch); };
  long reach = 0;
  for (const BondFamily &bond : bonds)
    reach = std::max(reach, lines(bond.fibre.direction, bond.length));

  const auto law = std::make_shared<LayeredMaterial>(LessBonds(whole), layers_);
  std::shared_ptr<LayeredViscosity> dashpots;
  if (viscosity != nullptr)
    dashpots = std::make_shared<LayeredViscosity>(dynamic_cast<const FibreViscosity &>(*viscosity), layers_);
  for (long layer = 1; layer <= reach; ++layer)
  {
    layers_->depths.push_back(static_cast<double>(layer) * pitch);
    std::vector<FibreFamily> cut;
    for (const BondFamily &bond : bonds)
      if (lines(bond.fibre.direction, bond.length) >= layer)
        cut.push_back(bond.fibre);
    law->laws.emplace_back(whole, CauchyBorn(std::move(cut)));
    if (dashpots == nullptr)
      continue;
    std::vector<FibreDashpot> remaining = dashpots->dashpots();
    for (FibreDashpot &dashpot : remaining)
      dashpot.weight *= lines(dashpot.direction, dashpot.length) >= layer ? 0.5 : 1.;
    dashpots->laws.emplace_back(std::move(remaining));
  }
  law_ = law;
  viscosity_ = dashpots;
}

double Flank::cut_to(const double X, const Sheet &sheet, const Sheet::Vector &u)
{
  const double before = layers_->depths.empty() ? 0. : sheet.energy(u);
  cut_to(X);
  return layers_->depths.empty() ? 0. : before - sheet.energy(u);
}
} // namespace latcon::continuum
