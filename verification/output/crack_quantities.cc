#include "verification/output/crack_quantities.h"

namespace latcon::output
{
namespace
{

// Adds a measured quantity and its uncertainty, one standard deviation.
void add_measured(std::vector<CrackQuantity> &all, const std::string &name, const std::string &unit)
{
  all.push_back({name, unit});
  all.push_back({name + "_uncertainty", unit});
}

// Lengths that are recorded in m and divided by d.
const std::vector<std::string> lengths_of_oscillation{"wavelength", "amplitude", "crest_amplitude"};

std::vector<CrackQuantity> all_quantities()
{
  std::vector<CrackQuantity> all{{"zeta", "1"}};
  for (const char *name : {"speed_lagrangian", "speed_laboratory"})
    add_measured(all, name, "m/s");
  for (const std::string &name : lengths_of_oscillation)
  {
    add_measured(all, name, "m");
    add_measured(all, name + "_over_d", "1");
  }
  all.push_back({"periods", "1"});
  all.push_back({"window_begin", "m"});
  all.push_back({"window_end", "m"});
  all.push_back({"branched_fraction", "1"});
  for (const char *name :
       {"bonds_broken", "detached_sites", "detached_fragments", "largest_fragment", "overstretched_bonds"})
    all.push_back({name, "1"});
  all.push_back({"bridged_length", "m"});
  all.push_back({"flank_damage_depth", "m"});
  all.push_back({"flank_damage_share", "1"});
  all.push_back({"end_time", "s"});
  all.push_back({"energy_imbalance", "1"});
  const auto add_near_tip = [&all](const std::vector<std::string> &names, const std::string &unit)
  {
    for (const std::string &name : names)
      add_measured(all, name, unit);
  };
  all.push_back({"samples", "1"});
  add_near_tip({"negative_zone_area", "negative_zone_area_of_samples"}, "m^2");
  add_near_tip({"negative_zone_length", "negative_zone_distance"}, "m");
  add_near_tip({"negative_zone_depth", "negative_zone_depth_of_samples"}, "m/s");
  add_near_tip({"negative_zone_depth_X", "negative_zone_depth_Y"}, "m");
  add_near_tip(
    {"velocity_asymmetry", "velocity_asymmetry_of_samples", "vortices", "vortices_of_samples", "samples_with_vortex"},
    "1");
  add_near_tip({"vortex_distance"}, "m");
  add_near_tip({"vortex_circulation", "tip_circulation"}, "m^2/s");
  add_near_tip({"process_zone_length"}, "m");
  add_near_tip({"process_zone_share", "process_zone_share_of_samples"}, "1");
  add_near_tip({"process_zone_fastest"}, "m/s");
  for (const std::string radius : {"4d", "8d"})
  {
    add_near_tip({"opening_stress_angle_" + radius}, "degrees");
    add_near_tip({"opening_stress_ratio_" + radius}, "1");
    add_near_tip({"opening_stress_peak_" + radius}, "Pa");
    add_near_tip({"opening_stress_concentration_" + radius}, "1");
  }
  add_near_tip({"wedge_angle"}, "degrees");
  add_near_tip({"speed_over_shear", "speed_over_longitudinal"}, "1");
  for (const std::string name : {"shear_speed", "longitudinal_speed", "process_zone_speed"})
    all.push_back({name, "m/s"});
  all.push_back({"far_opening_stress", "Pa"});
  return all;
}

} // namespace

const std::vector<CrackQuantity> &crack_quantities()
{
  static const std::vector<CrackQuantity> all = all_quantities();
  return all;
}

} // namespace latcon::output
