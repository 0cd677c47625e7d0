#pragma once

#include <random>

#include <boost/math/distributions/normal.hpp>

namespace latcon::study
{

/// Returns a random number of the standard normal distribution: the quantile of a uniform one with 53 random bits,
/// which is neither 0 nor 1. Unlike std::normal_distribution, which may differ from library to library, it gives the
/// same numbers everywhere.
inline double standard_normal(std::mt19937_64 &generator)
{
  const double uniform = (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53;
  return boost::math::quantile(boost::math::normal(), uniform);
}

} // namespace latcon::study
