#pragma once

#include <cstdint>
#include <string>

#include "lattice/disorder.h"

namespace latcon::input
{

class Parameters;

/// Entries of a case for the disorder of bonds.
struct DisorderCase
{
  /// A distribution as entries give it.
  struct Factors
  {
    lattice::Distribution::Kind kind = lattice::Distribution::Kind::none;
    double width = 0.1; ///< standard deviation [-]

    /// Returns whether the distribution allows the width, as distribution() requires.
    bool is_valid() const;
    /// Returns the distribution; none also if the width is not valid.
    lattice::Distribution distribution() const;
  };

  Factors strength;
  Factors stiffness;
  std::uint64_t seed = 1;

  void declare(Parameters &parameters);
  /// Reports widths that their distribution does not allow.
  void check(Parameters &parameters) const;
  lattice::Disorder disorder() const { return {strength.distribution(), stiffness.distribution(), seed}; }
};

} // namespace latcon::input
