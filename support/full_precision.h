#pragma once

#include <string>

namespace latcon::support
{

/// The shortest decimal text that reads back to the same double, bit for bit, in any locale: 0.1 -> "0.1".
/// Not-a-number gives "nan" (its sign and payload are lost), infinities "inf" and "-inf".
[[nodiscard]] std::string full_precision(double value);

} // namespace latcon::support
