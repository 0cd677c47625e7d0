#include "lattice/bonds/library_law.h"

#include <sstream>
#include <utility>

#include <dlfcn.h>

#include "support/require.h"

namespace latcon::lattice
{
namespace
{

template <class Function>
Function *function_of(void *library, const char *name)
{
  void *const address = dlsym(library, name);
  if (address == nullptr)
    throw InvalidBondLaw(std::string("it has no function `") + name + "`; see lattice/bonds/bond_law_library.h");
  return reinterpret_cast<Function *>(address); // NOLINT: the way of POSIX
}

} // namespace

LawLibrary::LawLibrary(const std::string &path)
{
  // A name without a folder would be searched in the system's folders.
  const std::string file = path.find('/') == std::string::npos ? "./" + path : path;
  // It stays loaded: laws may outlive this object.
  void *const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library == nullptr)
  {
    const char *const reason = dlerror();
    throw InvalidBondLaw(reason != nullptr ? reason : "it cannot be loaded");
  }
  const int version = function_of<decltype(latcon_bond_law_version)>(library, "latcon_bond_law_version")();
  if (version != LATCON_BOND_LAW_VERSION)
    throw InvalidBondLaw("it has version " + std::to_string(version) +
                         " of the interface; required: " + std::to_string(LATCON_BOND_LAW_VERSION));
  const char *const names = function_of<decltype(latcon_bond_law_parameters)>(library, "latcon_bond_law_parameters")();
  std::istringstream words(names != nullptr ? names : "");
  for (std::string word; words >> word;)
    parameters.push_back(word);
  force = function_of<decltype(latcon_bond_law_force)>(library, "latcon_bond_law_force");
  derivatives = function_of<decltype(latcon_bond_law_derivatives)>(library, "latcon_bond_law_derivatives");
}

LibraryLaw::LibraryLaw(LawLibrary library, std::vector<double> parameters, double longest)
  : library_(std::move(library)), parameters_(std::move(parameters))
{
  support::require(parameters_.size() == library_.parameters.size(),
                   "a law needs one value for each of its parameters");
  at_rest_ = derivatives(1.)[0];
  check(longest);
  const auto derivative = [this](std::size_t k) { return [this, k](double l) { return derivatives(l)[k]; }; };
  check_law({derivative(0), derivative(1), derivative(2), derivative(3), derivative(4)}, longest);
}

std::array<double, 5> LibraryLaw::derivatives(double stretch) const noexcept
{
  std::array<double, 5> psi{};
  library_.derivatives(stretch, parameters_.data(), psi.data());
  psi[0] -= at_rest_;
  return psi;
}

} // namespace latcon::lattice
