#pragma once

#include <filesystem>

#include "verification/analysis/near_tip_fields.h"

namespace latcon::output
{

/// Writes the means around a tip as an image for ParaView (.vti), which replaces `path` atomically.
///
/// Points are those of the grid, in the reference configuration relative to the tip [m]; warp by `displacement` for the
/// current one. Arrays, units and index order as in FieldWriter, and in addition excess_displacement [m],
/// strain_gradient_x, strain_gradient_y [1/m] and occupancy [-]; NaN at points without a site. The field data array
/// Samples is the number of samples.
/// @throws support::OutputError if the file cannot be written
void write_near_tip_field(const analysis::NearTipField &field, const std::filesystem::path &path);

} // namespace latcon::output
