#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "verification/analysis/near_tip_fields.h"

namespace latcon::analysis
{

/// Material ahead of the tip that moves against the crack, v_x < -fraction * crack speed. In a steady field that is
/// where rubber is stretched along x beyond the loaded sheet (theory.md, eq. (N.1)).
struct NegativeZone
{
  double area;                    ///< reference [m^2]; 0 if there is none
  double length;                  ///< extent along X, reference [m]; 0 if there is none
  std::optional<double> distance; ///< from the tip to its nearest point along X [m]; none if there is none
  double depth;                   ///< most negative v_x ahead of the tip [m/s], <= 0, in the zone or not
  Eigen::Vector2d deepest;        ///< where that is, reference, relative to the tip [m]
};

/// Fraction of the crack's laboratory speed above which backward motion counts [-].
inline constexpr double negative_zone_limit = 0.01;

/// @param laboratory_speed of the crack [m/s], > 0 @param fraction of it [-]
NegativeZone negative_zone(const NearTipField &field, double laboratory_speed, double fraction = negative_zone_limit);

/// |v - M v| / |v| [-] of a velocity field (theory.md, eq. (N.3)), M v its mirror image in the axis Y = Y_tip: (v_x,
/// -v_y)(X, -Y). Norms are root mean squares over the points that hold material together with their images. 0 for a
/// symmetric field, sqrt2 for one side moving alone, 2 for an antisymmetric field. None without such points, or at
/// rest.
std::optional<double> velocity_asymmetry(const NearTipField &field);

/// Integral of v . dx [m^2/s] along a circle around `centre`, both reference and relative to the tip,
/// counter-clockwise, x being the current positions on it. @param across_opening parts of the circle that meet no
/// material are left out; otherwise there is no value if there are such parts
std::optional<double> circulation(const NearTipField &field, const Eigen::Vector2d &centre, double radius,
                                  bool across_opening);

/// A point around which the material turns.
struct Vortex
{
  Eigen::Vector2d position; ///< reference, relative to the tip [m]
  double circulation;       ///< on the circle of radius 2 d around it [m^2/s]; > 0: counter-clockwise
  double speed;             ///< mean along that circle [m/s], >= 0
};

/// Critical points v = 0 of the laboratory velocity with Poincare index +1 and complex eigenvalues of dv/dx, whose
/// circle of radius 2 d lies in material. Nearest to the tip first.
/// @param slowest speed along the circle [m/s], >= 0; what turns no faster is left out
/// @param within distance of their cells from the tip, reference [m]
std::vector<Vortex> vortices(const NearTipField &field, double slowest,
                             double within = std::numeric_limits<double>::infinity());

/// Material behind the tip that follows the crack.
struct FollowingZone
{
  double length;         ///< extent along X, reference [m]; 0 if there is none
  double fastest;        ///< largest v_x behind the tip [m/s], in the zone or not
  Eigen::Vector2d place; ///< where that is, reference, relative to the tip [m]
};

/// Points behind the tip with v_x > `speed`, connected to each other and to some that are at most 8 pitches from the
/// tip: the tip is the foremost damaged site, and the sheet comes apart within a few spacings of it.
FollowingZone following_zone(const NearTipField &field, double speed);

/// v_x [m/s] of the material just behind the tip, in the order of the grid: of the points that hold material at
/// -14 d <= X <= -3 d, |Y| <= 3 d, reference, relative to the tip. Empty if none does. Nearer to the tip bonds still
/// break; farther behind it the flanks have parted.
///
/// The paper: "a small zone behind the crack tip in which the mass points move rapidly along the crack direction. Such
/// a zone can be regarded as a process zone and exists only in the case of oscillation. It fades for a straight crack."
/// The share of these points above a given speed measures that zone also where it is a crescent across the path, which
/// following_zone() sees as short.
std::vector<double> speeds_behind_tip(const NearTipField &field);

/// v_x [m/s] of the points ahead of the tip that move against the crack, v_x < 0, in the order of the grid.
///
/// The paper: "a negative velocity zone (NVZ) ahead of the crack tip in which the mass points move in the opposite
/// direction of the crack propagation". A zone that wanders with an oscillating path is blurred in the mean over
/// samples. These speeds are what a sample keeps until the speed of the crack, and with it the limit, is known.
std::vector<double> backward_speeds(const NearTipField &field);

/// The stress sigma_yy around the tip, mean of both sides.
struct OpeningStress
{
  double angle; ///< of the peak to the direction of the crack, reference [degrees], >= 0
  double ratio; ///< peak over the value straight ahead [-], >= 1; above 1 the field has a lobe on either side
  double peak;  ///< [Pa], Cauchy
};

/// On a circle around the tip, up to 120 degrees off the crack's direction: beyond that the flanks, pulled along
/// themselves, have a stress that opens nothing. None where less than that holds material or nothing pulls ahead.
/// @param radius reference [m]
std::optional<OpeningStress> opening_stress(const NearTipField &field, double radius);

/// Full angle between the flanks of a crack [rad] from current positions of sites relative to the tip [m].
///
/// Strips of width `pitch.x()` along x divide -to <= x <= -from. In each the widest gap in y between sites that follow
/// each other is the opening, if it exceeds two pitches, and the sites on either side of it are the flanks, to each of
/// which a straight line y(x) is fitted. None unless half the strips show an opening.
/// @param pitch of the lattice in the loaded sheet along x and y [m], > 0
/// @throws std::invalid_argument for `to` < `from`, or a pitch or a distance out of range
std::optional<double> wedge_angle(const std::vector<Eigen::Vector2d> &sites, const Eigen::Vector2d &pitch, double from,
                                  double to);

} // namespace latcon::analysis
