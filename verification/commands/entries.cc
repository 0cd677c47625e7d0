#include <filesystem>
#include <iostream>

#include "support/atomic_file.h"
#include "support/ranks.h"
#include "support/text_wrap.h"
#include "verification/commands/command.h"
#include "verification/input/case_text.h"
#include "verification/input/files.h"
#include "verification/input/spelling.h"

namespace latcon::commands
{
namespace
{

namespace fs = std::filesystem;
using Entries = std::vector<input::Declaration>;

constexpr std::size_t page_columns = 120;

// The entries of cases.
const input::Parameters &declared()
{
  static input::Case input;
  static input::Parameters parameters;
  if (parameters.sections().empty())
    input.declare(parameters);
  return parameters;
}

// The text in lines that begin below one another, the first after `before`.
std::string hanging(const std::string &before, const std::string &text)
{
  const std::size_t indent = support::width_of(before);
  std::string lines;
  for (const std::string &line : support::wrap_text(text, page_columns - indent))
    lines += (lines.empty() ? before : std::string(indent, ' ')) + line + "\n";
  return lines;
}

// Table of the entries of a section: name, unit, default, meaning.
std::string section_text(const std::string &section)
{
  constexpr std::size_t name_width = 20, unit_width = 8, default_width = 22;
  std::string text = section + "\n";
  for (const input::Declaration &entry : declared().declarations())
    if (entry.section == section)
    {
      const std::string value = entry.presence == input::Presence::required ? "required" : entry.default_text;
      text += hanging("  " + support::padded(entry.name, name_width) +
                        support::padded(entry.unit == "1" ? "-" : entry.unit, unit_width) +
                        support::padded(value, default_width) + " ",
                      entry.documentation);
    }
  return text;
}

// All that is declared of one entry, and how to set it.
std::string entry_text(const input::Declaration &entry)
{
  std::string text = entry.key() + "\n" + hanging("  ", entry.documentation);
  if (!entry.unit.empty())
    text +=
      "  unit:     " + (entry.unit == "1" ? "none" : entry.unit + "; a value may carry its unit, with any prefix") +
      "\n";
  if (!entry.rule.empty())
    text += hanging("  allowed:  ", entry.rule);
  text += "  default:  " +
          (entry.presence == input::Presence::required ? "none, the entry is required"
           : entry.default_text.empty()                ? "empty"
                                                       : entry.default_text) +
          "\n";
  const std::string value = entry.presence == input::Presence::required ? "..." : entry.default_text;
  text += "  in a case file:       subsection " + entry.section + "\n                          set " + entry.name +
          " = " + value + "\n                        end\n";
  return text + "  on the command line:  --set \"" + entry.key() + "=" + value + "\"\n";
}

// Equal but for capitals.
bool is_same_word(const std::string &a, const std::string &b)
{
  return input::typing_errors(a, b) == 0;
}

[[noreturn]] void refuse(const std::string &kind, const std::string &given, const std::vector<std::string> &known,
                         const std::string &otherwise)
{
  throw support::InputError("no " + kind + " '" + input::printable(given) + "'" +
                            input::nearest_hint(given, known, otherwise));
}

// Entries that a text may mean: Section/Name, or a name in any section.
Entries entries_named(const Entries &entries, const std::string &text)
{
  Entries named;
  for (const input::Declaration &entry : entries)
    if (is_same_word(text, entry.key()) || is_same_word(text, entry.name))
      named.push_back(entry);
  return named;
}

// The names that a mistyped topic is compared with: whole keys if it has a slash, otherwise names and sections.
std::vector<std::string> candidates(const Entries &entries, const std::string &topic,
                                    const std::vector<std::string> &commands)
{
  const bool is_key = topic.find('/') != std::string::npos;
  std::vector<std::string> known = is_key ? std::vector<std::string>{} : commands;
  for (const input::Declaration &entry : entries)
    known.push_back(is_key ? entry.key() : entry.name);
  if (!is_key)
    for (const std::string &section : declared().sections())
      known.push_back(section);
  return known;
}

std::string case_name(const std::string &directory)
{
  std::string name = fs::absolute(directory).lexically_normal().filename();
  if (name.empty()) // "DIR/"
    name = fs::absolute(directory).lexically_normal().parent_path().filename();
  return name.empty() ? "case" : name;
}

} // namespace

support::ExitCode print_entries(const std::string &section)
{
  const std::vector<std::string> sections = declared().sections();
  std::string text;
  for (const std::string &known : sections)
    if (section.empty() || is_same_word(section, known))
      text += (text.empty() ? "" : "\n") + section_text(known);
  if (text.empty())
    refuse("section", section, sections, "; sections: " + input::comma_separated(sections));
  if (support::is_root_rank())
    std::cout << text << "\nColumns: name, SI unit, default, meaning. One entry in full: latcon help Section/Name\n";
  return support::ExitCode::done;
}

support::ExitCode print_topic(const std::string &topic, const std::vector<std::string> &commands)
{
  const Entries entries = declared().declarations();
  for (const std::string &section : declared().sections())
    if (is_same_word(topic, section))
      return print_entries(section);
  const Entries named = entries_named(entries, topic);
  if (named.empty())
    refuse("command, section or entry", topic, candidates(entries, topic, commands),
           "; `latcon entries` lists all entries, `latcon --help` all commands");
  if (support::is_root_rank())
    for (const input::Declaration &entry : named)
      std::cout << entry_text(entry);
  return support::ExitCode::done;
}

support::ExitCode init(const input::Options &options, const std::string &directory)
{
  const std::string name = case_name(directory);
  const fs::path file = fs::path(directory) / (name + ".prm");
  if (support::is_root_rank() && fs::exists(file))
    throw support::InputError(file.string() + " exists; give another folder");
  const std::string source = input::shipped_case_file("start");
  const input::InputFile start = input::read_input_file(source);
  if (!start.problem.empty())
    throw support::InputError("cannot read the starting case " + source + ": " + start.problem);
  if (support::is_root_rank() && !options.dry_run)
  {
    support::create_folders(directory);
    support::write_atomically(file, start.text, support::Sync::yes);
    const std::string path = file.string();
    if (!options.quiet)
      std::cout << path << "\n\nrun it:       latcon fracture " << path << "\ncheck it:     latcon fracture " << path
                << " --dry-run\nits entries:  latcon entries\n";
  }
  return support::ExitCode::done;
}

} // namespace latcon::commands
