#pragma once

#include <cstdint>

namespace latcon::lattice
{

/// SplitMix64 (Steele, Lea, Flood 2014) as a counter-based generator: random bits as a function of a counter, so that
/// no order of sites or bonds is implied.
inline std::uint64_t splitmix64(std::uint64_t counter)
{
  std::uint64_t z = counter + 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

/// Uniform in [-1, 1), from the upper 53 bits.
inline double symmetric_uniform(std::uint64_t bits)
{
  return static_cast<double>(bits >> 11) * 0x1p-52 - 1.;
}

/// Distribution of a factor with mean 1 that multiplies a property of a bond (theory.md, eq. (L.36)).
class Distribution
{
public:
  enum class Kind
  {
    none,    ///< always 1
    uniform, ///< within sqrt3 widths of 1
    normal,  ///< cut off at `cut_off` standard deviations on either side, so that the mean remains 1
    weibull  ///< from 0 on
  };

  Distribution() = default;
  /// @param width standard deviation of the factor [-], > 0; less than widest(kind) for a bounded distribution, which
  /// keeps factors positive, and at most that for a Weibull distribution, whose density is finite at 0 then
  /// @throws std::invalid_argument for a width out of this range
  Distribution(Kind kind, double width);

  static constexpr double cut_off = 3.; ///< of the normal distribution, in its standard deviations before the cut
  /// Limit of the width [-], but for none; see the constructor.
  static double widest(Kind kind);

  bool is_none() const { return kind_ == Kind::none; }
  Kind kind() const { return kind_; }
  double width() const { return width_; }       ///< standard deviation [-]; 0 for none
  double smallest() const { return smallest_; } ///< bound on all factors from below [-], >= 0
  double largest() const { return largest_; }   ///< bound on all factors from above [-]; finite

  /// Factor that belongs to a key: a function of the key alone, whoever asks in which order. Different keys give
  /// independent factors.
  double factor(std::uint64_t key) const;

private:
  Kind kind_ = Kind::none;
  double width_ = 0.;
  double scale_ = 0.;    // half width; standard deviation before the cut; scale of the Weibull distribution
  double exponent_ = 0.; // 1 / shape of the Weibull distribution
  double smallest_ = 1., largest_ = 1.;
};

/// Disorder of the bonds of a sheet: every bond has its own factors, independent of all others.
struct Disorder
{
  Distribution strength;  ///< of the breaking stretch
  Distribution stiffness; ///< of the cross-section, which all forces of a bond are proportional to
  std::uint64_t seed = 1;

  bool is_none() const { return strength.is_none() && stiffness.is_none(); }
};

} // namespace latcon::lattice
