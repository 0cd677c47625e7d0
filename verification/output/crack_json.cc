#include "verification/output/crack_json.h"

#include <nlohmann/json.hpp>

namespace latcon::output
{

nlohmann::ordered_json crack_json(const analysis::CrackMeasurement &measurement)
{
  nlohmann::ordered_json json;
  json["pattern"] = to_string(measurement.pattern);
  json["reason"] = measurement.reason;
  const auto put = [&json](const std::string &name, const std::optional<analysis::Measured> &measured)
  {
    json[name] = measured ? nlohmann::ordered_json(measured->value) : nlohmann::ordered_json(nullptr);
    json[name + "_uncertainty"] =
      measured ? nlohmann::ordered_json(measured->uncertainty) : nlohmann::ordered_json(nullptr);
  };
  put("speed_lagrangian", measurement.speed_lagrangian);
  put("speed_laboratory", measurement.speed_laboratory);
  put("wavelength", measurement.wavelength);
  put("amplitude", measurement.amplitude);
  put("crest_amplitude", measurement.crest_amplitude);
  json["periods"] = measurement.periods;
  json["window_begin"] = measurement.X_begin;
  json["window_end"] = measurement.X_end;
  json["branched_fraction"] = measurement.branched_fraction;
  const analysis::CrackMeasurementOptions limits;
  json["thresholds"] = {
    {"run_in_fraction", limits.run_in_fraction},       {"clamp_fraction", limits.clamp_fraction},
    {"min_wavelength", limits.min_wavelength},         {"min_amplitude", limits.min_amplitude},
    {"max_steepness", limits.max_steepness},           {"min_share", limits.min_share},
    {"max_straight_rms", limits.max_straight_rms},     {"min_periods", limits.min_periods},
    {"clear_periods", limits.clear_periods},           {"min_log_evidence", limits.min_log_evidence},
    {"clear_log_evidence", limits.clear_log_evidence}, {"steady_amplitude", limits.steady_amplitude},
    {"arrest_fraction", limits.arrest_fraction},       {"min_branched_fraction", limits.min_branched_fraction}};
  return json;
}

} // namespace latcon::output
