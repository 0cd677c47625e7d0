#include <utility>
#include <vector>

#include "support/full_precision.h"
#include "verification/input/case.h"

namespace latcon::input
{

using Kind = lattice::Distribution::Kind;

bool DisorderCase::Factors::is_valid() const
{
  const double widest = lattice::Distribution::widest(kind);
  return kind == Kind::none || width < widest || (kind == Kind::weibull && width == widest);
}

lattice::Distribution DisorderCase::Factors::distribution() const
{
  return kind != Kind::none && is_valid() ? lattice::Distribution(kind, width) : lattice::Distribution();
}

void DisorderCase::declare(Parameters &parameters)
{
  const std::vector<std::pair<std::string, Kind>> kinds{
    {"none", Kind::none}, {"uniform", Kind::uniform}, {"normal", Kind::normal}, {"weibull", Kind::weibull}};
  const Range width({1e-4, true}, {1., true});
  parameters.add(
    "Disorder", "strength", strength.kind, kinds,
    "distribution of the factor, with mean 1, that multiplies lam_f (bond-energy: the critical energy) of each bond, "
    "toughened or not; normal is cut off at three standard deviations");
  parameters.add("Disorder", "strength width", strength.width, width, "1",
                 "standard deviation of the factor of lam_f; below 0.577 if uniform, below 0.328 if normal");
  parameters.add("Disorder", "stiffness", stiffness.kind, kinds,
                 "distribution of the factor, with mean 1, that multiplies the cross-section of each bond, and with it "
                 "its elastic and viscous force and its energy");
  parameters.add("Disorder", "stiffness width", stiffness.width, width, "1",
                 "standard deviation of the factor of the cross-section, in the range of `strength width`");
  parameters.add("Disorder", "seed", seed, any_number, "seed of the factors of the bonds");
}

void DisorderCase::check(Parameters &parameters) const
{
  for (const auto &[name, factors] : {std::pair("strength", &strength), std::pair("stiffness", &stiffness)})
    if (!factors->is_valid())
      parameters.error(std::string("Disorder/") + name + " width",
                       "a " + std::string(factors->kind == Kind::uniform ? "uniform" : "normal") +
                         " distribution of positive factors has a width below " +
                         support::full_precision(lattice::Distribution::widest(factors->kind)) +
                         "; give less, or weibull",
                       {std::string("Disorder/") + name});
}

} // namespace latcon::input
