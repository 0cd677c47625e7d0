#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "lattice/material.h"
#include "verification/analysis/near_tip_measurement.h"

namespace latcon::claims
{

/// A straight crack driven through a sheet held at all edges: X_tip(t) = start + speed * t along the middle of the
/// sheet, from an unbroken sheet at rest at x = F X (theory-comparison.md, section "A running crack"). Both sides are
/// given these numbers and nothing else in common.
///
/// In the lattice the crack runs midway between the two rows of sites (columns of them, where rows run across the
/// crack) next above the axis, where each bond that crosses that line is cut as the tip passes the crossing point. The
/// lattice is symmetric about that line up to a shift by `stride()` along it. The tip therefore moves by a stride from
/// sample to sample, so that each point that moves with the tip meets sites of either side alike.
struct CrackDrive
{
  double spacing; ///< d [m]
  lattice::Orientation orientation;
  double length;          ///< of the sheet [m]
  double height;          ///< of the whole sheet [m]
  double start;           ///< X of the tip at t = 0 [m]; the left edge is at 0
  double speed;           ///< V [m/s] > 0
  unsigned int n_strides; ///< strides that the tip makes, >= n_samples

  static constexpr unsigned int n_samples = 4; ///< after the last strides

  bool rows_along() const { return orientation == lattice::Orientation::rows_along_crack; }
  /// Shift along the crack under which the lattice is its own mirror image, and way of the tip between samples [m].
  double stride() const { return spacing * (rows_along() ? 0.5 : std::sqrt(0.75)); }
  double stride_time() const { return stride() / speed; } ///< [s]
  /// Distance of lines of sites along the crack [m].
  double pitch() const { return spacing * (rows_along() ? std::sqrt(0.75) : 0.5); }
  double axis() const { return 0.5 * pitch(); }                                 ///< Y of the crack in the lattice [m]
  double tip(unsigned int strides) const { return start + strides * stride(); } ///< X [m]
  double end() const { return tip(n_strides); }                                 ///< last X of the tip [m]

  /// Places the start such that no sample meets the cut of a bond. @param near X [m]
  void start_near(double near) { start = (std::round(near / stride()) + first_phase) * stride(); }
  static constexpr double first_phase = 0.25; ///< of the start, in strides from a site
};

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
  explicit TipField(const CrackDrive &drive) : drive_(drive) {}

  void add(const TipSite &site, const TipValues &values);

  /// Distance from the tip within which dissipation counts as near it [d].
  static constexpr double near_tip = 5.;
  /// Power dissipated within it by the whole sheet [W/m].
  double near_power() const { return 2. * pitch().prod() * near_ / CrackDrive::n_samples; }

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

  Eigen::Vector2d pitch() const { return {drive_.stride(), drive_.pitch()}; } ///< of the points, reference [m]

private:
  struct Sum
  {
    TipValues values;
    unsigned int n = 0;
  };

  CrackDrive drive_;
  std::map<std::pair<long, long>, Sum> sums_; // by j, i
  double near_ = 0.;                          // sum of the dissipation of sites near the tip
};

/// Zone of the upper half of the field that moves against the crack, of points at most `reach` [m] from the tip.
/// @param limit [m/s] >= 0
analysis::NegativeZone negative_zone(const TipField &field, double limit, double reach);

/// Opening stress on a circle around the tip; no numbers where the field does not reach or is no number.
/// @param radius [m]
analysis::OpeningStress opening_stress(const TipField &field, double radius);

/// Energies that a sheet lost while its tip advanced, per reference length of crack and thickness [J/m^2].
struct CrackEnergy
{
  double lost;       ///< of stored and kinetic energy
  double dissipated; ///< by viscosity anywhere
  double taken;      ///< at the crack: held by bonds when they were cut, or work against the forces that held it shut
  double near;       ///< dissipated by viscosity within TipField::near_tip, by its rate at the samples
};

/// A crack that was driven, on either side.
struct TipRun
{
  TipField field;     ///< mean over the samples
  CrackEnergy energy; ///< between the middle of the run and its end
};

/// A series of frames, of one frame at the end of the drive: NAME.pvd in a folder.
struct CrackFrame
{
  std::string folder, name;
};

/// Drives the crack through a lattice, whose bonds break in no other way.
/// @param reach of the field around the tip [m]
/// @param frame none is written if empty @throws support::OutputError
TipRun drive_lattice_crack(const CrackDrive &drive, const lattice::Material &material, const Eigen::Matrix2d &F,
                           double reach, const std::optional<CrackFrame> &frame = {});

} // namespace latcon::claims
