#include "verification/commands/command_line.h"

#include <algorithm>

#include <CLI/CLI.hpp>

#include "verification/input/case_text.h"

namespace latcon::commands
{
namespace
{

bool is_option(const std::string &word)
{
  return word.size() > 1 && word[0] == '-';
}

// `word` without the value of `--option=value`.
std::string option_name(const std::string &word)
{
  return word.substr(0, word.find('='));
}

void append_options(std::vector<std::string> &names, const CLI::App &app)
{
  for (const CLI::Option *option : app.get_options())
    for (const std::string &name : option->get_lnames())
      names.push_back("--" + name);
}

std::string problem(const CLI::App &app, const CLI::App *command, const CLI::ParseError &error)
{
  const std::vector<std::string> left = app.remaining(true); // words that the parser could not use
  const auto option = std::find_if(left.begin(), left.end(), is_option);
  const auto word = std::find_if_not(left.begin(), left.end(), is_option);
  if (command == nullptr && word != left.end())
  {
    const std::vector<std::string> names = command_names(app);
    return "unknown command '" + input::printable(*word) + "'" +
           input::nearest_hint(*word, names, "; commands: " + input::comma_separated(names));
  }
  if (option != left.end())
  {
    std::vector<std::string> names;
    append_options(names, app);
    if (command != nullptr)
      append_options(names, *command);
    return "unknown option " + input::printable(option_name(*option)) +
           input::nearest_hint(option_name(*option), names);
  }
  if (dynamic_cast<const CLI::ExtrasError *>(&error) != nullptr && word != left.end())
    return "unexpected argument '" + input::printable(*word) + "'";
  if (command == nullptr && dynamic_cast<const CLI::RequiredError *>(&error) != nullptr)
    return "a command is required: " + input::comma_separated(command_names(app));
  return error.what();
}

} // namespace

std::vector<std::string> command_names(const CLI::App &app)
{
  std::vector<std::string> names;
  for (const CLI::App *command : app.get_subcommands([](const CLI::App *one) { return !one->get_group().empty(); }))
    names.push_back(command->get_name());
  return names;
}

std::string usage_error(const CLI::App &app, const CLI::ParseError &error)
{
  const std::vector<CLI::App *> parsed = app.get_subcommands();
  const CLI::App *const command = parsed.empty() ? nullptr : parsed.front();
  return problem(app, command, error) + "; see latcon " + (command != nullptr ? command->get_name() + " " : "") +
         "--help";
}

} // namespace latcon::commands
