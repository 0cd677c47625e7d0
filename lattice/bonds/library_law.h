#pragma once

#include <array>
#include <string>
#include <vector>

#include "lattice/bonds/bond_law_library.h"
#include "lattice/bonds/law_check.h"

namespace latcon::lattice
{

/// A shared library with the functions of bond_law_library.h. It remains loaded until the program ends.
struct LawLibrary
{
  /// @throws InvalidBondLaw for a file that cannot be loaded, a missing function, or another version of the interface
  explicit LawLibrary(const std::string &path);

  std::vector<std::string> parameters; ///< their names, in order
  decltype(&latcon_bond_law_force) force;
  decltype(&latcon_bond_law_derivatives) derivatives;
};

/// Bond law of a shared library.
class LibraryLaw : public CheckedLaw
{
public:
  /// @param parameters values [SI], one for each name in library.parameters
  /// @param longest largest stretch of an unbroken bond [-], > 1
  /// @throws InvalidBondLaw as check_law does for stretches from smallest_checked_stretch on
  LibraryLaw(LawLibrary library, std::vector<double> parameters, double longest);

  double energy(double stretch) const noexcept override { return derivatives(stretch)[0]; }
  double force(double stretch) const noexcept override { return library_.force(stretch, parameters_.data()); }
  double stiffness(double stretch) const noexcept override { return derivatives(stretch)[2]; }

  /// psi and its first four derivatives [Pa], with psi(1) = 0.
  std::array<double, 5> derivatives(double stretch) const noexcept;

private:
  LawLibrary library_;
  std::vector<double> parameters_;
  double at_rest_ = 0.; // [Pa], psi(1) as the library gives it
};

} // namespace latcon::lattice
