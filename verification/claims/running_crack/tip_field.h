#pragma once

#include <vector>

#include <Eigen/Core>

#include "verification/claims/running_crack/crack_drive.h"

namespace latcon::claims
{

/// Compared quantities at a point near the tip, in the upper half of the sheet.
struct TipValues
{
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero(); ///< [m/s]
  Eigen::Vector2d excess = Eigen::Vector2d::Zero();   ///< x - F X [m]
  double opening_stress = 0.;                         ///< P_yY, first Piola, elastic and viscous [Pa]
  double dissipation = 0.;                            ///< by viscosity, per reference area [W/m^3]
  // In a continuum only, norms of first Piola stresses [Pa]:
  double anisotropy = 0.;    ///< of the lattice's own bonds less its mean over rotations, at its F
  double excess_stress = 0.; ///< elastic stress less that of the loaded sheet

  TipValues &operator+=(const TipValues &other);
  TipValues operator*(double factor) const;
};

/// Position of a sample relative to the tip: xi = X - X_tip, eta = |Y - Y_crack| [m].
struct TipSite
{
  std::size_t place; ///< in the lattice
  double X;          ///< reference [m]
  double xi, eta;    ///< [m]
  bool is_above;     ///< of the crack
};

/// Sites of a lattice that a sample with the tip at X meets within `reach` [m] of it.
std::vector<TipSite> tip_sites(const CrackDrive &drive, const lattice::TriangularLattice &sheet, double X_tip,
                               double reach);

/// Means over samples at points that move with the tip, a rectangular grid over the upper half: xi = (i - 1/4) stride,
/// eta = (j - 1/2) pitch, j >= 1. Both sides of a comparison are averaged in this way from values at the same sites.
class TipField
{
public:
  /// @param reach of the grid ahead of the tip, behind it and above it [m]
  TipField(const CrackDrive &drive, double reach);

  void add(const TipSite &site, const TipValues &values);

  /// A point of the grid that has values.
  struct Point
  {
    double xi, eta; ///< [m]
    TipValues values;
    double radius() const { return std::hypot(xi, eta); }
  };
  /// Points of the grid that sites met. Each of them has as many from above as from below.
  std::vector<Point> points() const;

  /// Values between the points, bilinear, the lower half being the mirror image of the upper; not-a-number where a
  /// point without values is needed.
  TipValues at(double xi, double eta) const;

  double point_area() const { return drive_.stride() * drive_.pitch(); } ///< reference area per point [m^2]

private:
  struct Sum
  {
    TipValues values;
    unsigned int n = 0;
  };
  const Sum *find(int i, int j) const;

  CrackDrive drive_;
  int columns_; // i from -columns_ to columns_
  int rows_;
  std::vector<Sum> sums_;
};

/// Material ahead of the tip that moves against the crack, v_x < -limit.
struct BackwardZone
{
  double area;  ///< reference, both halves [m^2]
  double depth; ///< most negative v_x ahead of the tip [m/s], <= 0
};

/// @param limit [m/s] >= 0 @param reach points farther from the tip are left out [m]
BackwardZone backward_zone(const TipField &field, double limit, double reach);

/// Opening stress on a circle around the tip, up to 120 degrees off the crack's direction.
struct StressLobes
{
  double angle; ///< of the largest value [degrees], >= 0
  double ratio; ///< largest value over that straight ahead [-]
  double ahead; ///< straight ahead [Pa]
};

/// The lobes on the circle of that radius [m], which must lie within the field.
StressLobes stress_lobes(const TipField &field, double radius);

} // namespace latcon::claims
