#include "verification/output/output_file.h"

#include <ostream>
#include <sstream>

#include "support/atomic_file.h"
#include "support/errors.h"
#include "verification/output/output_list.h"

namespace latcon::output
{

void write_file(const std::string &path, const std::string &text)
{
  list_output(path);
  support::write_atomically(path, text, support::Sync::yes);
}

void write_file(const std::string &path, const std::function<void(std::ostream &)> &writer)
{
  std::ostringstream text;
  writer(text);
  if (!text)
    throw support::OutputError(path, "error while formatting its content");
  write_file(path, text.str());
}

void write_files(const TextFiles &files)
{
  for (const auto &[path, text] : files)
    write_file(path, text);
}

} // namespace latcon::output
