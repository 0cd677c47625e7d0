#include "verification/claims/claim_outcome.h"

#include <filesystem>

#include "verification/output/output_file.h"

namespace latcon::claims
{

void ClaimOutcome::write_tables(const std::string &folder) const
{
  for (const auto &[name, rows] : tables)
    output::write_file((std::filesystem::path(folder) / (name + ".csv")).string(), rows.csv());
}

} // namespace latcon::claims
