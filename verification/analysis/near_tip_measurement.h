#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "verification/analysis/near_tip_fields.h"

namespace latcon::analysis
{

/// Zone ahead of the tip in which material moves against the crack, v_x < -fraction * crack speed. In a steady field
/// the rubber there is stretched along x more than the loaded sheet (theory.md, eq. (N.1)).
struct NegativeZone
{
  double area;                    ///< reference [m^2]; 0 without a zone
  double length;                  ///< extent along X, reference [m]; 0 without a zone
  std::optional<double> distance; ///< from the tip to its nearest point along X, reference [m]; none without a zone
  double depth;                   ///< most negative v_x ahead of the tip [m/s], <= 0, inside or outside of the zone
  Eigen::Vector2d deepest;        ///< position of this velocity, reference, relative to the tip [m]
};

/// Fraction of the crack's laboratory speed above which backward motion counts [-].
inline constexpr double negative_zone_limit = 0.01;

/// v_x [m/s] of material at a reference position relative to the tip [m].
struct PointVelocity
{
  Eigen::Vector2d X;
  double v;
};

/// Measures the zone, v_x < -limit, from the points of a rectangular grid that have material; those behind the tip do
/// not count. A velocity that is no number makes area and depth one that is none.
/// @param pitch of the grid along X and Y [m] @param limit [m/s] >= 0
NegativeZone negative_zone(const std::vector<PointVelocity> &points, const Eigen::Vector2d &pitch, double limit);

/// Measures it in a field. @param laboratory_speed speed of the crack [m/s], > 0 @param fraction threshold as a
/// fraction of this speed [-]
NegativeZone negative_zone(const NearTipField &field, double laboratory_speed, double fraction = negative_zone_limit);

/// Returns the asymmetry |v - M v| / |v| [-] of a velocity field (theory.md, eq. (N.3)), with its mirror image M v in
/// the axis Y = Y_tip: (v_x, -v_y)(X, -Y). Norms are root mean squares over points that contain material, as do their
/// images. 0 for a symmetric field, sqrt2 if only one side moves, 2 for an antisymmetric field. None without such
/// points, or at rest.
std::optional<double> velocity_asymmetry(const NearTipField &field);

/// Returns the circulation [m^2/s], the integral of v . dx counter-clockwise along a circle, with current positions x.
/// `centre` and `radius` [m] are in the reference configuration, `centre` relative to the tip. @param across_opening
/// true to skip parts of the circle without material; false to return none if there are such parts
std::optional<double> circulation(const NearTipField &field, const Eigen::Vector2d &centre, double radius,
                                  bool across_opening);

/// Point around which the material rotates.
struct Vortex
{
  Eigen::Vector2d position; ///< reference, relative to the tip [m]
  double circulation;       ///< on the circle of radius 2 d around the point [m^2/s]; > 0: counter-clockwise
  double speed;             ///< mean along that circle [m/s], >= 0
};

/// Finds critical points v = 0 of the laboratory velocity with Poincare index +1 and complex eigenvalues of dv/dx,
/// whose circle of radius 2 d lies in material. In the order of their distance from the tip.
/// @param slowest speed along the circle [m/s], >= 0; only faster vortices are returned
/// @param within largest distance of their cells from the tip, reference [m]
std::vector<Vortex> vortices(const NearTipField &field, double slowest,
                             double within = std::numeric_limits<double>::infinity());

/// Zone behind the tip in which material follows the crack.
struct FollowingZone
{
  double length;         ///< extent along X, reference [m]; 0 without a zone
  double fastest;        ///< largest v_x behind the tip [m/s], inside or outside of the zone
  Eigen::Vector2d place; ///< position of this velocity, reference, relative to the tip [m]
};

/// Measures the zone of points behind the tip with v_x > `speed` [m/s] that are connected to points at most 8 pitches
/// from the tip. The tip is the foremost damaged site; the sheet separates within a few spacings of it.
FollowingZone following_zone(const NearTipField &field, double speed);

/// Returns v_x [m/s] of the material just behind the tip, in the order of the grid: of points with material at -14 d <=
/// X <= -3 d, |Y| <= 3 d, reference, relative to the tip. Empty if there is none. Closer to the tip bonds still break;
/// farther behind it the flanks have separated.
///
/// The paper: "a small zone behind the crack tip in which the mass points move rapidly along the crack direction. Such
/// a zone can be regarded as a process zone and exists only in the case of oscillation. It fades for a straight crack."
/// The fraction of these points above a given speed measures this zone also if it is a crescent across the path, for
/// which following_zone() is short.
std::vector<double> speeds_behind_tip(const NearTipField &field);

/// Returns v_x [m/s] of the points ahead of the tip that move against the crack, v_x < 0, in the order of the grid.
///
/// The paper: "a negative velocity zone (NVZ) ahead of the crack tip in which the mass points move in the opposite
/// direction of the crack propagation". A zone that wanders with an oscillating path is blurred in the mean over
/// samples. Each sample keeps these speeds until the speed of the crack, and hence the threshold, is known.
std::vector<double> backward_speeds(const NearTipField &field);

/// Angular dependence of the stress sigma_yy around the tip, mean of both sides.
struct OpeningStress
{
  double angle; ///< between the peak and the direction of the crack, reference [degrees], >= 0
  double ratio; ///< peak over the value straight ahead [-], >= 1; above 1 the field has a lobe on each side
  double peak;  ///< [Pa], Cauchy
};

/// Measures the stress on a circle around the tip up to 120 degrees from the direction of the crack; beyond that the
/// stress in the flanks is along the crack and does not open it. None if a part of this arc has no material or if the
/// stress ahead is not tensile.
/// @param stress mean of both sides [Pa] at an angle [rad] to the direction of the crack; none where material is
/// missing
std::optional<OpeningStress> opening_stress(const std::function<std::optional<double>(double)> &stress);

/// Measures it in a field. @param radius reference [m]
std::optional<OpeningStress> opening_stress(const NearTipField &field, double radius);

/// Returns the full angle between the flanks of a crack [rad] from current positions of sites relative to the tip [m].
///
/// Strips of width `pitch.x()` along x divide -to <= x <= -from. In each strip the widest gap in y between consecutive
/// sites is the opening, if it exceeds two pitches. The sites on its two sides belong to the flanks; a straight line
/// y(x) is fitted to each flank. None unless half the strips have an opening.
/// @param pitch pitch of the lattice in the loaded sheet along x and y [m], > 0
/// @throws std::invalid_argument for `to` < `from`, or a pitch or a distance out of range
std::optional<double> wedge_angle(const std::vector<Eigen::Vector2d> &sites, const Eigen::Vector2d &pitch, double from,
                                  double to);

} // namespace latcon::analysis
