#include "continuum/network_gradient.h"

#include <algorithm>
#include <cmath>

namespace latcon::continuum
{
namespace
{
// Merges families with the same potential into one with their mean squared length.
std::vector<BondFamily> merge_families(const std::vector<BondFamily> &families)
{
  std::vector<BondFamily> result;
  for (const BondFamily &family : families)
  {
    check(family);
    const auto same =
      std::find_if(result.begin(), result.end(),
                   [&](const BondFamily &other) { return other.fibre.potential == family.fibre.potential; });
    if (same == result.end())
    {
      result.push_back(family);
      continue;
    }
    const double weight = same->fibre.weight + family.fibre.weight;
    same->length = std::sqrt(
      (same->fibre.weight * same->length * same->length + family.fibre.weight * family.length * family.length) /
      weight);
    same->fibre.weight = weight;
  }
  return result;
}

std::vector<BondFamily> in_all_directions(const std::vector<BondFamily> &families)
{
  std::vector<BondFamily> result;
  for (BondFamily family : merge_families(families))
  {
    family.fibre.weight /= NetworkGradient::n_directions;
    for (const dealii::Tensor<1, 2> &direction : directions(NetworkGradient::n_directions))
    {
      family.fibre.direction = direction;
      result.push_back(family);
    }
  }
  return result;
}
} // namespace

NetworkGradient::NetworkGradient(const std::vector<BondFamily> &families, const double length)
  : LatticeGradient(in_all_directions(families), length)
{
}
} // namespace latcon::continuum
