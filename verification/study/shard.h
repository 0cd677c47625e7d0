/// Shares of a study, one for each task of a job array.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "verification/study/study_plan.h"

namespace latcon::study
{

/// One of `count` shares of the runs of a study.
struct Shard
{
  std::size_t index = 1; ///< from 1 to count
  std::size_t count = 1;
};

/// Parses `I/N` with 1 <= I <= N <= 100,000. @throws InputError
[[nodiscard]] Shard parse_shard(const std::string &text);

/// Indices of the runs of a shard, the most expensive first. Every count-th run of longest_first() is in the same
/// shard, so that shards have about the same cost.
[[nodiscard]] std::vector<std::size_t> runs_of_shard(const std::vector<PlannedRun> &plan, const Shard &shard);

/// Name of the file in the output directory of a study that its shards share.
inline constexpr const char *plan_file_name = "plan.json";

/// Text of plan.json: number of shards, the runs in their order with the SHA-256 of their resolved cases, and whether
/// they verify their material and pre-stretch. The same study gives the same text.
/// @param n_shards 0: any number, for a comparison
[[nodiscard]] std::string plan_text(const std::string &title, const std::vector<PlannedRun> &plan,
                                    bool skip_verification, std::size_t n_shards);

/// First difference between the plan in a file and that of this study, in words.
/// @return an empty text if they are the same
[[nodiscard]] std::string plan_difference(const std::string &stored, const std::string &wanted);

} // namespace latcon::study
