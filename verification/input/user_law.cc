#include "verification/input/user_law.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <mutex>
#include <set>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include "lattice/bonds/expression_law.h"
#include "lattice/bonds/law_check.h"
#include "lattice/bonds/library_law.h"
#include "verification/input/case_text.h"
#include "verification/input/expression_parser.h"
#include "verification/input/files.h"
#include "verification/input/units.h"

namespace latcon::input
{
namespace
{

using Values = std::map<std::string, double>;

constexpr const char *variable = "lam";

// Reads `mu = 0.1 MPa, alpha = 2`.
Values parameters_of(const std::string &text)
{
  Values values;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');)
  {
    const std::size_t equals = part.find('=');
    const std::string name = trimmed(part.substr(0, equals));
    const auto wrong = [&](const std::string &what)
    { throw UserLaw::Problem("parameters", "'" + printable(trimmed(part)) + "': " + what); };
    if (equals == std::string::npos)
      wrong("expected NAME = NUMBER, separated by commas");
    if (!is_value_name(name) || name == variable)
      wrong("a name is a letter followed by letters, digits and underscores, and neither a function nor lam");
    const std::string number = trimmed(part.substr(equals + 1));
    const ParsedNumber pure = read_quantity(number, "1");
    const ParsedNumber stress = pure.wrong.empty() ? pure : read_quantity(number, "Pa");
    if (!stress.wrong.empty())
      wrong("expected a number, without a unit or with one of stress");
    if (!values.emplace(name, stress.value).second)
      wrong("set twice");
  }
  return values;
}

std::string sha256_of_library(const std::string &path)
{
  std::error_code error;
  const bool is_file = std::filesystem::is_regular_file(path, error); // others, such as devices, may be endless
  errno = 0;
  std::string sha256 = is_file ? sha256_of_file(path) : "";
  if (!sha256.empty())
    return sha256;
  if (is_file)
    error = std::error_code(errno, std::generic_category());
  throw UserLaw::Problem("library", "cannot read the library: " + (error ? error.message() : "it is not a file"));
}

struct LoadedLibrary
{
  lattice::LawLibrary functions;
  std::string sha256; // of the file that was loaded
};

// Loads a library at the first call for its path. A process continues with it if the file is replaced: the functions
// in memory remain those that were loaded.
const LoadedLibrary &loaded_library(const std::string &path)
{
  static std::mutex mutex;
  static std::map<std::string, LoadedLibrary> loaded;
  if (path.empty())
    throw UserLaw::Problem("library", "the path of a shared library is required");
  const std::lock_guard<std::mutex> lock(mutex);
  const auto known = loaded.find(path);
  if (known != loaded.end())
    return known->second;
  std::string sha256 = sha256_of_library(path);
  lattice::LawLibrary functions(path);
  if (sha256_of_library(path) != sha256)
    throw UserLaw::Problem("library", "the library changed while it was loaded");
  return loaded.emplace(path, LoadedLibrary{std::move(functions), std::move(sha256)}).first->second;
}

std::string list_of(const std::vector<std::string> &names)
{
  return names.empty() ? "none" : comma_separated(names);
}

std::vector<double> in_order_of_library(const std::vector<std::string> &names, const Values &given)
{
  for (const auto &[name, value] : given)
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw UserLaw::Problem("parameters", "the library has no parameter '" + name + "'; it has: " + list_of(names));
  std::vector<double> values;
  for (const std::string &name : names)
  {
    const auto own = given.find(name);
    if (own == given.end())
      throw UserLaw::Problem("parameters", "the library needs '" + name + "'; its parameters: " + list_of(names));
    values.push_back(own->second);
  }
  return values;
}

// Values that psi does not use would suggest that they matter.
support::Expression expression_of(const std::string &psi, const Values &given, const Values &constants)
{
  Values values = given;
  values.insert(constants.begin(), constants.end()); // names of parameters come first
  std::set<std::string> used;
  support::Expression expression = parse_expression(psi, variable, values, &used);
  for (const auto &[name, value] : given)
    if (used.count(name) == 0)
      throw UserLaw::Problem("parameters", "psi does not use '" + name + "'; it uses: " +
                                             list_of(std::vector<std::string>(used.begin(), used.end())));
  return expression;
}

} // namespace

void UserLaw::declare(Parameters &p, const std::string &section)
{
  p.add(section, "psi", psi,
        "law = expression: energy of a bond per reference volume in Pa, as a function of its stretch `lam`, of a, b, "
        "modulus and the parameters, with + - * / ^ ( ) sqrt exp log")
    .read_by = ReadBy::claims;
  p.add(section, "parameters", parameters,
        "laws expression and library: values of the parameters that they use, as in `mu = 0.1 MPa, k = 2`")
    .read_by = ReadBy::claims;
  p.add(section, "library", library, "law = library: path of a shared library with the functions of a bond law")
    .read_by = ReadBy::claims;
  p.add(section, "library sha256", sha256,
        "SHA-256 that the library must have; if empty, that of the library found, in the resolved case")
    .read_by = ReadBy::claims;
}

void UserLaw::check(Parameters &p, const std::string &section, bool is_library, const Values &constants, double longest)
{
  try
  {
    (void)law(is_library, constants, longest);
    if (is_library)
      sha256 = loaded_library(library).sha256;
    is_usable = true;
  }
  catch (const Problem &problem)
  {
    p.error(section + "/" + problem.entry, problem.what(), {section + "/law"});
  }
}

std::shared_ptr<const lattice::CustomBondLaw> UserLaw::law(bool is_library, const Values &constants,
                                                           double longest) const
{
  const Values given = parameters_of(parameters);
  const std::string entry = is_library ? "library" : "psi";
  try
  {
    if (!is_library)
      return std::make_shared<lattice::ExpressionLaw>(expression_of(psi, given, constants), longest);
    const LoadedLibrary &loaded = loaded_library(library);
    if (!sha256.empty() && loaded.sha256 != sha256)
      throw Problem("library sha256", "the library " + printable(library) + " has the SHA-256 " + loaded.sha256);
    std::vector<double> in_order = in_order_of_library(loaded.functions.parameters, given);
    return std::make_shared<lattice::LibraryLaw>(loaded.functions, std::move(in_order), longest);
  }
  catch (const InvalidExpression &error)
  {
    throw Problem(entry, error.what());
  }
  catch (const lattice::InvalidBondLaw &error)
  {
    throw Problem(entry, error.what());
  }
}

} // namespace latcon::input
