#include "verification/output/histories.h"

#include <cmath>

namespace latcon::output
{
namespace
{

// The tip hops between sites, so its speed is meaningful only over several of them.
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

std::string TipHistory::csv() const
{
  Table table({"t", "X", "Y", "x", "y", "speed", "bonds_broken"});
  for (std::size_t i = 0; i < records_.size(); ++i)
  {
    const analysis::TipRecord &tip = records_[i];
    table.add({tip.t, tip.X, tip.Y, tip.x, tip.y, speeds_[i], broken_[i]});
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
