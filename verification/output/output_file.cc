#include "verification/output/output_file.h"

#include "support/atomic_file.h"
#include "verification/output/output_list.h"

namespace latcon::output
{

void write_file(const std::string &path, const std::string &text)
{
  list_output(path);
  support::write_atomically(path, text, support::Sync::yes);
}

void write_files(const TextFiles &files)
{
  for (const auto &[path, text] : files)
    write_file(path, text);
}

} // namespace latcon::output
