/// Files that come with latcon, input files of the user, cases and studies, and hashes of files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace latcon::input
{

/// Folder of the data files: cases/, studies/, report/, paraview/. It is the nearest share/latcon above the running
/// program; the build folder has one that links to the sources. If none exists, the folder where an installation would
/// have it.
std::string data_folder();

/// Name of the module with the finite elements, which the program loads on demand.
inline constexpr const char *module_name = "latcon_elements.so";

/// Returns the path of the module beside the program, or in lib/latcon beside its folder, where it is installed; empty:
/// there is none.
[[nodiscard]] std::string module_file();

/// Content of a file, or the reason why it could not be read.
struct InputFile
{
  std::string text;
  std::string problem; ///< empty if the file was read
};

/// Reads a file of at most 16 MiB. Of a longer one, such as an endless device, no more than that is read.
[[nodiscard]] InputFile read_input_file(const std::string &path);

/// Names of the shipped cases, sorted: files of the data folder's cases/, without folder and ending.
[[nodiscard]] std::vector<std::string> shipped_cases();

/// Names of the shipped studies, likewise.
[[nodiscard]] std::vector<std::string> shipped_studies();

/// File of a shipped case.
[[nodiscard]] std::string shipped_case_file(const std::string &name);

/// File of the case that a user names: a shipped case, unless there is a file of that name. Any other name is returned
/// unchanged.
[[nodiscard]] std::string case_path(const std::string &name);

/// Shipped cases, as a hint for a user whose file was not found: "; nearest shipped case: quick" or
/// "; shipped cases: fig1, quick". @param path as the user gave it
[[nodiscard]] std::string shipped_case_hint(const std::string &path);

/// Returns the SHA-256 (FIPS 180-4) of `bytes`, as 64 hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

/// Returns the SHA-256 of a file without its first `skipped` bytes; empty if the file cannot be read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path &path, std::size_t skipped = 0);

} // namespace latcon::input
