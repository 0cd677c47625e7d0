#include "lattice/bonds/memories.h"

#include <cmath>
#include <string>

#include "support/require.h"

namespace latcon::lattice
{
namespace
{

struct Decay
{
  double factor; // e^-r
  double mean;   // (1 - e^-r) / r, mean of e^-s for s from 0 to r
};

// By basic operations, whose bits do not depend on the processor: Taylor's series where it converges fast, then
// e^-2r = (e^-r)^2.
Decay decay_over(double r)
{
  constexpr double vanished = 750.; // e^-r is below the smallest double
  if (r > vanished)
    return {0., 1. / r};
  constexpr double small = 0.5;
  constexpr int n_terms = 14; // the next one is below 0.5^14 / 15! = 5e-17
  int n_doublings = 0;
  for (; r > small; r *= 0.5)
    ++n_doublings;
  double mean = 1.;
  for (int n = n_terms; n >= 2; --n)
    mean = 1. - r / n * mean;
  Decay result{1. - r * mean, mean};
  for (; n_doublings > 0; --n_doublings)
    result = {result.factor * result.factor, 0.5 * result.mean * (1. + result.factor)};
  return result;
}

} // namespace

MaxwellMemory::MaxwellMemory(std::vector<Branch> branches)
  : MemoryProperties{branches.size(), branches.size(), 0., false}, branches_(std::move(branches))
{
  support::require(branches_.size() <= max_history_variables, "a Maxwell memory has at most " +
                                                                std::to_string(max_history_variables) +
                                                                " branches, not " + std::to_string(branches_.size()));
  for (const auto &[modulus, time] : branches_)
  {
    support::require(modulus > 0. && time > 0. && std::isfinite(modulus) && std::isfinite(time),
                     "a Maxwell branch needs a modulus > 0 and a relaxation time > 0, not " + std::to_string(modulus) +
                       " Pa and " + std::to_string(time) + " s");
    largest_stiffness += modulus;
  }
  set_duration(0.);
}

void MaxwellMemory::set_duration(double duration)
{
  for (std::size_t i = 0; i < branches_.size(); ++i)
  {
    const auto &[modulus, time] = branches_[i];
    const Decay of_branch = decay_over(duration / time);
    decay[i] = of_branch.factor;
    gain[i] = modulus * of_branch.mean;
    fluency[i] = 1. / (modulus * time);
  }
}

PlasticMemory::PlasticMemory(double E, double Y, double K)
  : MemoryProperties{2, 1, E, true}, modulus(E), yield_stress(Y), hardening(K), slip(1. / (E + K))
{
  support::require(E > 0. && Y > 0. && K >= 0. && std::isfinite(E + Y + K),
                   "a plastic memory needs a modulus > 0, a yield stress > 0 and a hardening >= 0, not " +
                     std::to_string(E) + " Pa, " + std::to_string(Y) + " Pa and " + std::to_string(K) + " Pa");
}

CustomMemory::CustomMemory(std::shared_ptr<const CustomMemoryLaw> law) : law_(std::move(law))
{
  support::require(law_ != nullptr, "a memory needs a law");
  static_cast<MemoryProperties &>(*this) = {law_->n_variables(), 1, law_->largest_stiffness(),
                                            law_->is_rate_independent()};
  support::require(n_variables >= 1 && n_variables <= max_history_variables,
                   "a memory has 1 to " + std::to_string(max_history_variables) + " variables, not " +
                     std::to_string(n_variables));
  support::require(largest_stiffness >= 0. && std::isfinite(largest_stiffness),
                   "a memory needs a finite stiffness >= 0, not " + std::to_string(largest_stiffness) + " Pa");
  std::array<double, max_history_variables> at_rest{};
  const double overstress = law_->advance(0., 1., 1., at_rest.data());
  support::require(overstress == 0. && law_->stored_energy(1., at_rest.data()) == 0. &&
                     law_->dissipation(1., at_rest.data()) == 0.,
                   "a memory holds neither overstress nor energy while its variables are 0, and dissipates nothing");
}

} // namespace latcon::lattice
