#include "verification/input/parameters.h"

#include "support/errors.h"
#include "support/text_wrap.h"
#include "verification/input/case_text.h"
#include "verification/input/files.h"

#include <cctype>
#include <filesystem>
#include <stdexcept>

namespace latcon::input
{

namespace
{

// Problems beyond these are counted, not shown: a wrong file would fill the screen and the memory.
constexpr std::size_t most_problems = 50;

// Sections that cases no longer have, and what replaced them.
const std::map<std::string, std::string> replaced_sections{
  {"Damage", "Nonlocal and Fracture (docs/continuum-crack.md)"}};

// Width of a comment on an entry in a resolved case, which has lines of at most 78 columns.
constexpr std::size_t comment_width = 74;

// Comment on an entry in a resolved case: what it means, its unit, what is allowed.
std::string comment_on(const Declaration &entry)
{
  std::string allowed = entry.rule;
  if (entry.presence == Presence::required)
    allowed += allowed.empty() ? "required" : "; required";
  return entry.documentation + (entry.unit.empty() ? "" : " [" + entry.unit + "]") +
         (allowed.empty() ? "" : " (" + allowed + ")");
}

} // namespace

std::string Parameters::Entry::place() const
{
  if (overridden)
    return "--set";
  return file_place.empty() ? "default" : file_place;
}

void Parameters::read_file(const std::string &path)
{
  file_ = printable(path, path.size());
  const InputFile input = read_input_file(path);
  if (input.problem.empty())
    read_text(input.text, path);
  else
  {
    unreadable_ = true;
    std::error_code none;
    report(file_, "cannot read the case: " + input.problem +
                    (std::filesystem::exists(path, none) ? "" : shipped_case_hint(path)));
  }
}

void Parameters::read_text(const std::string &text, const std::string &name)
{
  file_ = printable(name, name.size());
  std::string ending = std::filesystem::path(name).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](const unsigned char c) { return std::tolower(c); });
  for (const auto &item : ending == ".json" ? read_json(text, file_) : read_prm(text, file_))
    if (const auto *problem = std::get_if<SyntaxProblem>(&item))
    {
      report(problem->place, problem->text);
      unreadable_ = unreadable_ || problem->ends_case;
    }
    else if (const auto *start = std::get_if<SectionStart>(&item))
    {
      // Reported once, not for each entry in the section.
      if (!has_section(start->section))
        report(start->place, "unknown subsection '" + printable(start->section) + "'" +
                               nearest_section(start->section) + "; known: " + comma_separated(sections()));
    }
    else if (const auto *assignment = std::get_if<Assignment>(&item))
    {
      const std::string shown = printable(assignment->name) + " = " + printable(assignment->value) + ": ";
      if (assignment->section.empty())
        report(assignment->place, shown + "outside of any subsection" + nearest_key("", assignment->name));
      else if (has_section(assignment->section))
        set(*assignment, assignment->section + "/" + shown, false);
    }
}

void Parameters::read_overrides(const std::vector<std::string> &overrides)
{
  for (const std::string &text : overrides)
    take_override(text);
}

void Parameters::take_override(const std::string &text)
{
  const std::size_t equals = text.find('=');
  const std::size_t slash = text.find('/');
  if (equals == std::string::npos || slash == std::string::npos || slash > equals)
  {
    const std::string key = trimmed(text.substr(0, equals));
    const std::string nearest = slash < equals
                                  ? nearest_key(trimmed(key.substr(0, slash)), trimmed(key.substr(slash + 1)))
                                  : nearest_key("", key);
    report("--set", "not understood: '" + printable(text) + "'" + nearest + "; allowed: --set Section/Name=value");
    return;
  }
  const Assignment assignment{"--set", trimmed(text.substr(0, slash)),
                              trimmed(text.substr(slash + 1, equals - slash - 1)), trimmed(text.substr(equals + 1))};
  const std::string &section = assignment.section;
  const std::string shown = printable(section + "/" + assignment.name) + " = " + printable(assignment.value) + ": ";
  if (has_section(section))
    set(assignment, shown, true);
  else
    report("--set", shown + "unknown subsection '" + printable(section) + "'" + nearest_key(section, assignment.name) +
                      "; known: " + comma_separated(sections()));
}

// Gives a value to an entry of a section that exists. @param shown key and value for messages
void Parameters::set(const Assignment &assignment, const std::string &shown, const bool is_override)
{
  const auto found = keys_.find(assignment.section + "/" + assignment.name);
  if (found == keys_.end())
  {
    report(assignment.place, shown + "unknown key" + nearest_key(assignment.section, assignment.name) + "; known in " +
                               assignment.section + ": " + known_entries(assignment.section));
    return;
  }
  Entry &entry = entries_[found->second];
  if (is_override ? entry.overridden : !entry.file_place.empty())
  {
    entry.wrong = true;
    report(assignment.place, shown + "set twice, first " + (is_override ? "" : "at " + entry.file_place + " ") + "to " +
                               printable(entry.text));
    return;
  }
  if (is_override)
    entry.overridden = true;
  else
    entry.file_place = assignment.place;
  entry.text = assignment.value;
  std::string wrong = unwritable(entry.text);
  if (wrong.empty())
    wrong = entry.read(entry.text);
  if (!wrong.empty())
  {
    entry.wrong = true;
    report(entry.place(), entry.key() + " = " + printable(entry.text) + ": " + wrong + "; allowed: " + entry.allowed);
  }
}

void Parameters::report(const std::string &place, const std::string &text)
{
  ++n_problems_;
  if (problems_.size() < most_problems)
    problems_.push_back(place + ": " + text);
}

const Parameters::Entry &Parameters::find(const std::string &key) const
{
  const auto found = keys_.find(key);
  if (found == keys_.end())
    throw std::logic_error("parameters: '" + key + "' is not declared");
  return entries_[found->second];
}

void Parameters::error(const std::string &key, const std::string &text, const std::vector<std::string> &also)
{
  if (unreadable_)
    return; // without the file these are defaults
  const auto bad = [this](const std::string &k)
  {
    const Entry &entry = find(k);
    return entry.wrong || (entry.presence == Presence::required && !entry.is_set());
  };
  bool consequence = bad(key);
  std::string others;
  for (const std::string &other : also)
  {
    consequence = consequence || bad(other);
    others += (others.empty() ? "; with " : ", ") + other + " = " + printable(find(other).write()) + " (" +
              find(other).place() + ")";
  }
  if (consequence)
    return;
  const Entry &entry = find(key);
  report(entry.place(),
         key + " = " + printable(entry.is_set() ? entry.text : entry.default_text) + ": " + text + others);
}

bool Parameters::good() const
{
  return n_problems_ == 0 &&
         std::none_of(entries_.begin(), entries_.end(),
                      [](const Entry &entry) { return entry.presence == Presence::required && !entry.is_set(); });
}

void Parameters::finish()
{
  if (!unreadable_)
    for (const Entry &entry : entries_)
      if (entry.presence == Presence::required && !entry.is_set())
        report(printable(file_),
               entry.key() + ": required, but not set; allowed: " + entry.allowed + "; it is: " + entry.documentation);
  if (n_problems_ == 0)
    return;
  std::vector<std::string> problems = problems_;
  if (n_problems_ > problems.size())
    problems.push_back("... and " + std::to_string(n_problems_ - problems.size()) + " more problems");
  throw support::InputError(std::move(problems));
}

bool Parameters::has_section(const std::string &section) const
{
  return std::any_of(entries_.begin(), entries_.end(), [&](const Entry &entry) { return entry.section == section; });
}

std::vector<std::string> Parameters::sections() const
{
  std::vector<std::string> sections;
  for (const Entry &entry : entries_)
    if (std::find(sections.begin(), sections.end(), entry.section) == sections.end())
      sections.push_back(entry.section);
  return sections;
}

std::string Parameters::known_entries(const std::string &section) const
{
  std::vector<std::string> names;
  for (const Entry &entry : entries_)
    if (entry.section == section)
      names.push_back(entry.name);
  return comma_separated(names);
}

std::string Parameters::nearest_section(const std::string &section) const
{
  if (const auto found = replaced_sections.find(section); found != replaced_sections.end())
    return "; replaced by " + found->second;
  return nearest_hint(section, sections());
}

std::string Parameters::nearest_key(const std::string &section, const std::string &name) const
{
  if (replaced_sections.count(section) > 0)
    return nearest_section(section);
  const Entry *nearest = nullptr;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const Entry &entry : entries_)
    if (could_mean(name, entry.name))
    {
      // Another section is a further mistake to assume; how much of one depends on how its name is spelt.
      const std::size_t errors =
        typing_errors(name, entry.name) + std::min<std::size_t>(typing_errors(section, entry.section), 3);
      if (errors < least)
      {
        least = errors;
        nearest = &entry;
      }
    }
  return nearest == nullptr ? "" : "; nearest known key: " + nearest->key();
}

std::string Parameters::resolved_text() const
{
  // The layout is that of dealii::ParameterHandler::print_parameters().
  std::string text = "# Listing of Parameters\n# ---------------------\n";
  for (const std::string &section : sections())
  {
    std::size_t longest_name = 0, longest_value = 0;
    for (const Entry &entry : entries_)
      if (entry.section == section)
      {
        longest_name = std::max(longest_name, entry.name.size());
        longest_value = std::max(longest_value, entry.write().size());
      }
    text += "subsection " + section + "\n";
    bool is_first = true;
    for (const Entry &entry : entries_)
      if (entry.section == section)
      {
        text += std::exchange(is_first, false) ? "" : "\n";
        for (const std::string &line : support::wrap_text(comment_on(entry), comment_width))
          text += "  # " + line + "\n";
        const std::string value = entry.write();
        text += "  set " + entry.name + std::string(longest_name - entry.name.size(), ' ') + " = " + value;
        if (entry.presence != Presence::required && value != entry.default_text)
          text += std::string(longest_value - value.size() + 1, ' ') + "# default: " + entry.default_text;
        text += "\n";
      }
    text += "end\n\n\n";
  }
  return text;
}

std::vector<std::pair<std::string, std::string>> Parameters::values() const
{
  std::vector<std::pair<std::string, std::string>> values;
  for (const auto &[key, index] : keys_)
    values.emplace_back(key, entries_[index].write());
  return values;
}

std::vector<Declaration> Parameters::declarations() const
{
  return {entries_.begin(), entries_.end()};
}

std::string Parameters::lines(const std::string &section_left_out) const
{
  std::string text;
  for (const auto &[key, value] : values())
    if (section_left_out.empty() || key.rfind(section_left_out + "/", 0) != 0)
      text += key + " = " + value + "\n";
  return text;
}

} // namespace latcon::input
