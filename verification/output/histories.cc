#include "verification/output/histories.h"

#include <cmath>

namespace latcon::output
{
namespace
{

// The tip hops between sites, so its speed is meaningful only over several of them.
constexpr double speed_baseline = 6.; // in spacings

} // namespace

double TipHistory::speed_after(std::size_t n) const
{
  for (std::size_t i = n; i-- > 0;)
    if (const analysis::TipRecord &tip = records_[n - 1], &earlier = records_[i];
        tip.X - earlier.X >= speed_baseline * spacing_ && tip.t > earlier.t)
      return (tip.X - earlier.X) / (tip.t - earlier.t);
  return 0.;
}

std::string TipHistory::csv() const
{
  Table table({"t", "X", "Y", "x", "y", "speed", "bonds_broken"});
  for (std::size_t i = 0; i < records_.size(); ++i)
  {
    const analysis::TipRecord &tip = records_[i];
    table.add({tip.t, tip.X, tip.Y, tip.x, tip.y, speed_after(i + 1), tip.n_broken});
  }
  return table.csv();
}

void TipHistory::check_loaded(const double now) const
{
  require_increasing_times(records_, now, "tip", [](const analysis::TipRecord &tip) { return tip.t; });
  for (const analysis::TipRecord &tip : records_)
    support::require(std::abs(tip.X) <= length_ + spacing_, "`tip` is outside the sheet");
}

} // namespace latcon::output
