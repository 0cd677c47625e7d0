/// Refinement of a sweep where neighbouring cases have different patterns.
#pragma once

#include <cstddef>
#include <vector>

#include "verification/study/run_outcome.h"
#include "verification/study/study_file.h"
#include "verification/study/study_plan.h"

namespace latcon::study
{

/// Returns the runs half way between neighbours of a swept grid with different patterns: the points that bracket the
/// boundary between two patterns at half the distance.
///
/// Neighbours are points at the spacing of this level along one swept entry, with the same values of the others: the
/// spacing of the grid for level 1, half of it for level 2, and so on; values between those of the grid are
/// interpolated. Two points differ unless all seeds of both have the same pattern, where "undecided" is a pattern. A
/// point without a measured seed differs from none.
/// @param study with a sweep whose values are numbers, and with the runs of the earlier levels
/// @param plan runs of the study, with a seed each
/// @param outcomes in the same order
/// @param level from 1
/// @return runs with this level and the seeds of the sweep, named after their values; in a fixed order
/// @throws std::logic_error for a study without a sweep, or a value that is no number
[[nodiscard]] std::vector<StudyRun> refined_runs(const Study &study, const std::vector<PlannedRun> &plan,
                                                 const std::vector<RunOutcome> &outcomes, std::size_t level);

} // namespace latcon::study
