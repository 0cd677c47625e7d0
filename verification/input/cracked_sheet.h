/// The sheet of a case with its seed crack, as `latcon fracture` and the Python package step it.
#pragma once

#include <memory>

#include "lattice/simulation.h"
#include "verification/input/case.h"

namespace latcon::input
{

/// Returns the loaded sheet of a case with noise, ends, contact and the seed crack, before its first step. Collective.
/// @param input a case that bridge::require_fracture_case() accepts @param band of input.sheet(); must outlive the result
[[nodiscard]] std::unique_ptr<lattice::Simulation> cracked_sheet(const Case &input, const lattice::RowPartition &band);

} // namespace latcon::input
