/// Cases that come with latcon, known by name.
#pragma once

#include <string>
#include <vector>

namespace latcon::input
{

/// Names of the shipped cases, sorted: files of the data folder's cases/, without folder and ending.
[[nodiscard]] std::vector<std::string> shipped_cases();

/// File of a shipped case.
[[nodiscard]] std::string shipped_case_file(const std::string &name);

/// File of the case that a user names: a shipped case, unless there is a file of that name. Any other name is returned
/// unchanged.
[[nodiscard]] std::string case_path(const std::string &name);

/// Shipped cases, as a hint for a user whose file was not found: "; nearest shipped case: quick" or
/// "; shipped cases: fig1, quick". @param path as the user gave it
[[nodiscard]] std::string shipped_case_hint(const std::string &path);

} // namespace latcon::input
