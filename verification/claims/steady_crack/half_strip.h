#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace latcon::claims
{

/// A strip of the triangular lattice of nearest neighbours, linearised about its undeformed state, with rows along a
/// crack that runs midway between two of them. Top and bottom rows are held.
///
/// Units of the whole folder: d = 1 (spacing), k = 1 (spring constant of a bond [N/m]), m = 1 (mass of a site). Times
/// are then in sqrt(m/k), speeds in d sqrt(k/m).
struct CrackStrip
{
  std::size_t free_rows; ///< N, rows that move on each side of the crack, >= 1; with the held ones 2 N + 2 in all
  double viscosity;      ///< beta = c / sqrt(k m) [-], > 0: dashpot c [N s/m] beside each spring

  /// Gaps between neighbouring rows, 2 N + 1: elastic layers in series.
  std::size_t layers() const { return 2 * free_rows + 1; }
};

/// Speed of shear waves, sqrt(3/8) d sqrt(k/m); longitudinal waves are faster by sqrt3.
double shear_speed();

/// Response of the lower half of a strip to loads that move along it at a steady speed.
///
/// All fields are w(t - X/v) with the same w for all sites of a row (theory-comparison.md, eq. (S.2)). Transforms are
/// f(omega) = integral of f(s) exp(-i omega s), so that a step along the row by X is the factor exp(-i omega X/v). Rows
/// are counted down from the crack; the upper half is the mirror image.
class HalfStrip
{
public:
  using Complex = std::complex<double>;

  /// @param speed v of the crack, > 0 @throws std::invalid_argument for values out of range
  HalfStrip(const CrackStrip &strip, double speed);

  const CrackStrip &strip() const { return strip_; }
  double speed() const { return speed_; }

  /// kappa = 1 + i omega beta: complex stiffness of a bond.
  Complex stiffness(double omega) const { return {1., omega * strip_.viscosity}; }

  /// L(omega): the elongation that bonds across the crack lose if each of them pulls its ends together with a force of
  /// transform 1 and nothing else holds the crack together (theory-comparison.md, eqs. (S.3), (S.4)).
  Complex compliance(double omega) const;

  /// Elongations of the bonds of one gap between rows, and of the row below it.
  struct Layer
  {
    Complex right; ///< bonds that go up and to the right; in layer 0 those across the crack
    Complex left;  ///< bonds that go up and to the left
    Complex along; ///< bonds of the row below the gap; 0 for the held row
  };

  /// Elongations of all bonds of the half strip: layer 0 is the gap of the crack, layer N that above the held row.
  std::vector<Layer> elongations(double omega) const;

private:
  struct Rows;
  Rows rows(double omega) const;

  CrackStrip strip_;
  double speed_;
};

} // namespace latcon::claims
