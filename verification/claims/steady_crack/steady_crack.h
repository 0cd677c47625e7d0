#pragma once

#include "verification/claims/steady_crack/half_strip.h"

namespace latcon::claims
{

/// Driving Delta / Delta_G at which a crack runs steadily at speed v: the displacement of the held rows over that of
/// Griffith's threshold (theory-comparison.md, eq. (S.1)), from the exact solution of the linear lattice by the
/// Wiener-Hopf method (eq. (S.8)). Nothing of it is shared with the simulator.
/// @param speed v in d sqrt(k/m), > 0
/// @throws std::runtime_error if the integral does not converge
double steady_driving(const CrackStrip &strip, double speed);

/// The speed at which a crack runs steadily under a driving: the inverse of steady_driving on the branch where the
/// driving grows with speed, which is the stable one.
/// @param driving Delta / Delta_G, > 1
/// @param fastest upper end of the search, in d sqrt(k/m)
/// @throws std::runtime_error if no speed of that branch up to `fastest` has this driving
double steady_speed(const CrackStrip &strip, double driving, double fastest);

} // namespace latcon::claims
