#include "verification/claim_outcome.h"

#include <filesystem>

#include "verification/atomic_file.h"

namespace verification
{

void ClaimOutcome::write_tables(const std::string &folder) const
{
  for (const auto &[name, rows] : tables)
    write_file((std::filesystem::path(folder) / (name + ".csv")).string(), rows.csv());
}

} // namespace verification
