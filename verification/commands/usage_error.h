#pragma once

#include <string>
#include <vector>

namespace CLI
{
class App;
class ParseError;
} // namespace CLI

namespace latcon::commands
{

/// Names of the listed commands; those that only the Python package starts are not.
[[nodiscard]] std::vector<std::string> command_names(const CLI::App &app);

/// Message for a command line that could not be parsed: the unknown command, option or argument with the nearest known
/// one, otherwise the words of the parser; and which help to read.
[[nodiscard]] std::string usage_error(const CLI::App &app, const CLI::ParseError &error);

} // namespace latcon::commands
