#include "verification/output/histories.h"

#include <cmath>

namespace latcon::output
{
namespace
{

// The tip hops between sites, or advances by cells, so its speed is meaningful only over several of them.
constexpr double speed_baseline = 6.; // in spacings

} // namespace

void TipHistory::add(const analysis::TipRecord &tip, const std::size_t n_broken)
{
  double speed = 0.;
  for (auto earlier = records_.rbegin(); earlier != records_.rend(); ++earlier)
    if (tip.X - earlier->X >= speed_baseline * spacing_ && tip.t > earlier->t)
    {
      speed = (tip.X - earlier->X) / (tip.t - earlier->t);
      break;
    }
  records_.push_back(tip);
  speeds_.push_back(speed);
  broken_.push_back(n_broken);
}

std::string TipHistory::csv(const bool counts_bonds) const
{
  std::vector<std::string> columns{"t", "X", "Y", "x", "y", "speed"};
  if (counts_bonds)
    columns.emplace_back("bonds_broken");
  Table table(std::move(columns));
  for (std::size_t i = 0; i < records_.size(); ++i)
  {
    const analysis::TipRecord &tip = records_[i];
    std::vector<Table::Cell> row{tip.t, tip.X, tip.Y, tip.x, tip.y, speeds_[i]};
    if (counts_bonds)
      row.emplace_back(broken_[i]);
    table.add(std::move(row));
  }
  return table.csv();
}

void TipHistory::check_loaded(const double now) const
{
  lattice::require_archived(speeds_.size() == records_.size() && broken_.size() == records_.size(),
                            "the numbers of `speeds`, `broken_at_tip` and records of the tip do not match");
  require_increasing_times(records_, now, "tip", [](const analysis::TipRecord &tip) { return tip.t; });
  for (const analysis::TipRecord &tip : records_)
    lattice::require_archived(std::abs(tip.X) <= length_ + spacing_, "`tip` is outside the sheet");
}

} // namespace latcon::output
