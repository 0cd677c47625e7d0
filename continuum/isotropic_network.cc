#include "continuum/isotropic_network.h"

#include "continuum/errors.h"
#include "continuum/plane_invariants.h"

using dealii::Tensor;

namespace latcon::continuum
{
namespace
{
// Adds fibres of a family in all directions; those of equal potentials are one family.
void add_in_all_directions(std::vector<FibreFamily> &fibres, const FibreFamily &family)
{
  constexpr unsigned int n = IsotropicNetwork::n_directions;
  std::size_t first = 0;
  while (first < fibres.size() && !(fibres[first].potential == family.potential))
    first += n;
  if (first == fibres.size())
    for (const Tensor<1, 2> &direction : directions(n))
      fibres.push_back({direction, 0., family.potential});
  for (std::size_t k = first; k < first + n; ++k)
    fibres[k].weight += family.weight / n;
}
} // namespace

IsotropicNetwork::IsotropicNetwork(const std::vector<FibreFamily> &families)
{
  require(!families.empty(), "a fibre network needs at least one family");
  std::vector<FibreFamily> sampled;
  for (const FibreFamily &family : families)
  {
    check(family);
    const double c = family.weight;
    if (const auto *rod = std::get_if<RodPotential>(&family.potential))
    {
      a_ += c * rod->a;
      b_ += c * rod->b;
    }
    else if (const auto *spring = std::get_if<LinearPotential>(&family.potential))
      e_ += c * spring->e;
    else
      add_in_all_directions(sampled, family);
  }
  if (!sampled.empty())
    sampled_.emplace(std::move(sampled));
}

Response IsotropicNetwork::evaluate(const Tensor<2, 2> &F, const Order order) const
{
  const double J = checked_determinant(F);
  const double I = F.norm_square();
  const StretchMeans mean = stretch_means(I, J);
  const double r = 1. / J; // mean of l^-2; the mean of l^2 is I/2
  InvariantFunction W;
  W += a_ * InvariantFunction({0.25 * I - 1.5, 0.25, 0., 0., 0., 0.});
  W += a_ * mean.inverse;
  W += b_ * InvariantFunction({0.5 * r - 1.5, 0., -0.5 * r * r, 0., 0., r * r * r});
  W += (b_ - e_) * mean.stretch;
  W += e_ * InvariantFunction({0.25 * I + 0.5, 0.25, 0., 0., 0., 0.});
  Response result = response(W, F, order);
  if (sampled_)
  {
    const Response sum = sampled_->evaluate(F, order);
    result.energy += sum.energy;
    result.first_piola += sum.first_piola;
    result.tangent += sum.tangent;
  }
  return result;
}
} // namespace latcon::continuum
