#pragma once

#include <string>

namespace latcon::support
{

/// Returns the shortest decimal text that converts back to the same double, bit for bit, in any locale: 0.1 -> "0.1".
/// NaN gives "nan" (without sign and payload), infinities give "inf" and "-inf".
[[nodiscard]] std::string full_precision(double value);

} // namespace latcon::support
