/// Descriptor of a claim.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "lattice/material.h"
#include "verification/claims/rows.h"
#include "verification/claims/spectrum.h"

namespace latcon::claims
{

/// Everything that the program and the report know of a claim, given in claim_table.inc. The folder of a claim may hold
/// a `plots.py` with the plots of its tables in the report.
struct Claim
{
  std::string name;      ///< on the command line and in results: "wave-speeds"
  std::string title;     ///< one line for the help and the report
  std::string statement; ///< what the claim asserts, for the report

  bool is_default = true; ///< part of `latcon verify` without names

  /// The claim is part of the verification before fracture: a crack is refused if one of its rows fails, or if the
  /// quick version judges none.
  bool gate = false;

  /// The claim is about memories of bonds: part of `latcon verify` without names, and of verification before fracture,
  /// for materials with a memory only.
  bool is_about_memory = false;

  /// The claim is about a continuum that breaks: part of verification before fracture of the continuum only.
  bool is_about_continuum_fracture = false;

  /// The claim depends on nothing of a case, so that one verdict serves all cases of a program.
  bool is_about_program = false;

  /// Entries `Section/Name` that the claim reads besides those of a Subject.
  std::vector<std::string> entries = {};

  /// The quick version is run on the shells of the case, and not also on the nearest neighbours alone.
  bool quick_on_own_shells_only = false;

  /// The claim is about disorder of bonds: part of `latcon verify` without names for materials with disorder only.
  bool is_about_disorder = false;

  /// Returns whether `latcon verify` without names includes the claim. @param material of the lattice
  [[nodiscard]] bool is_default_for(const lattice::Material &material) const
  {
    return is_default && (!is_about_memory || has_branches(material)) &&
           (!is_about_disorder || !material.disorder.is_none());
  }
  /// Returns whether verification before fracture includes the claim. @param material of the sheet that breaks
  /// @param on_continuum whether the continuum breaks in place of the lattice
  [[nodiscard]] bool is_before_fracture(const lattice::Material &material, bool on_continuum = false) const
  {
    return gate && (on_continuum || !is_about_continuum_fracture) && (!is_about_memory || has_branches(material));
  }
};

/// Returns the name of the claim of a folder: "wave-speeds" of "wave_speeds".
inline std::string claim_name(std::string folder)
{
  std::replace(folder.begin(), folder.end(), '_', '-');
  return folder;
}

} // namespace latcon::claims
