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
  return json;
}

} // namespace latcon::output
