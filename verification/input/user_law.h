/// User-defined bond laws of a case: an expression, or a shared library.
#pragma once

#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "lattice/bonds/laws.h"
#include "verification/input/parameters.h"

namespace latcon::input
{

/// Entries of a bond law that is not built into latcon, for one shell of bonds.
struct UserLaw
{
  std::string psi;        ///< energy [Pa] as an expression of the stretch `lam`
  std::string parameters; ///< NAME = NUMBER, separated by commas
  std::string library;    ///< path of a shared library
  std::string sha256;     ///< of the library as loaded; empty: any. check() sets it for the resolved case

  /// An invalid entry of the law; what() gives the reason.
  struct Problem : std::runtime_error
  {
    Problem(std::string entry_, const std::string &text) : std::runtime_error(text), entry(std::move(entry_)) {}
    std::string entry; ///< its name
  };

  void declare(Parameters &p, const std::string &section);

  /// Reports a law that cannot be used, and sets `is_usable` and `sha256`.
  /// @param is_library whether the law is from the library, or the expression
  /// @param constants further values that psi, but no library, may name [SI]
  /// @param longest largest stretch of an unbroken bond [-]
  void check(Parameters &p, const std::string &section, bool is_library, const std::map<std::string, double> &constants,
             double longest);
  bool is_usable = false; ///< result of check()

  /// Creates the law, with the arguments of check(). @throws Problem
  std::shared_ptr<const lattice::CustomBondLaw> law(bool is_library, const std::map<std::string, double> &constants,
                                                    double longest) const;
};

} // namespace latcon::input
