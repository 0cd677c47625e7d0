#pragma once

#include "verification/claims/steady_crack/half_strip.h"

namespace latcon::claims
{

/// A crack in a strip of the simulator's own lattice: linear bonds between nearest neighbours, no toughening, strains
/// so small that the lattice is a linear one but for the breaking. Units as in CrackStrip.
struct CrackRunOptions
{
  CrackStrip strip;
  double driving;                ///< Delta / Delta_G of the held rows
  double breaking_strain = 1e-4; ///< lam_f - 1 [-]
  double time_step = 0.025;
  double length = 260.; ///< of the strip; its left end is free, the right one held
  double seed = 40.;    ///< cut along the middle before the strip comes to rest
  double kick = 4.;     ///< cut further at the start, to free a trapped crack
  double guided = 80.;  ///< up to here only bonds across the middle may break, since a crack that starts overshoots
  double window_begin = 110.; ///< what the tip does from here on is measured ...
  double window_end = 210.;   ///< ... up to here
};

/// Measurement of the crack in the window. Energies are per broken bond, divided by the energy k e_c^2 / 2 of a bond at
/// the breaking elongation.
struct CrackRun
{
  double speed;             ///< slope of the tip's record [d sqrt(k/m)]
  double broken;            ///< held by bonds when they broke; above 1, since time steps are finite
  double viscous;           ///< dissipated by the dashpots
  double released;          ///< by the springs, what broken bonds held included
  double kinetic;           ///< gained
  double largest_elsewhere; ///< elongation of a bond near the tip but not across the middle, over the breaking one
  std::size_t bonds_broken;
  std::size_t off_line; ///< bonds broken anywhere but across the middle, over the whole run

  /// Mean elongation at which bonds broke, over the breaking one: root mean square.
  double breaking_elongation() const;
};

/// Runs the simulator until the tip has passed the window.
/// @throws std::invalid_argument if the time step is not a stable one
/// @throws std::runtime_error if the crack stops before
CrackRun run_crack(const CrackRunOptions &options);

} // namespace latcon::claims
