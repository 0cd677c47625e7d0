#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "verification/claims/claim_outcome.h"
#include "verification/claims/prestretch/cut_comparison.h"

namespace latcon::claims
{

/// Sheets with a hole or a notch that the claim `prestretch` compares, and parameters of the comparison.
struct CutStudy
{
  std::string name; ///< "hole" or "notch", also of the table
  /// The sheet for a size of the cut [m] and F of the held edges.
  std::function<CutSheet(const bridge::Subject &, double size, const Eigen::Matrix2d &F)> sheet;
  std::vector<Eigen::Matrix2d> states = {}; ///< F of the held edges, not I; several biaxial ones
  std::vector<double> sizes = {};           ///< R/d or length/d of the local law, ascending, at least four
  std::vector<double> other_sizes = {};     ///< those of them at which the other laws are solved
  CutMesh mesh = {};
  /// Largest sizes whose errors are judged together, in the geometric mean, by what the smaller ones let one expect.
  std::size_t n_judged = 1;
  /// Report without judging, since not every law need have an equilibrium.
  bool is_reported = false;
  /// Fault that a test introduces into a lattice before the comparison; none otherwise.
  std::function<void(CutLattice &)> spoil = [](CutLattice &) {};
};

/// Sheets with a round hole.
CutStudy hole_study(bool quick);
/// Sheets with a round hole of a lattice of nearest neighbours, in one state and with more radii: the errors scatter
/// more from one radius to the next.
CutStudy nearest_hole_study(bool quick);
/// Sheets with a notch from a free edge, for both sets of shells.
CutStudy notch_study(bool quick);
/// A hole in the loaded sheet of the subject, to report which laws have an equilibrium there.
CutStudy loaded_hole_study(const Eigen::Matrix2d &F);

/// Name in place of a law if the lattice itself did not relax.
inline constexpr const char *no_lattice = "lattice that does not come to rest";

/// Comparison of a law with a lattice.
struct CutResult
{
  double size; ///< over d [-]
  std::string law;
  std::optional<CutErrors> errors;      ///< none: no equilibrium was found
  std::string failure;                  ///< why
  double residual;                      ///< of the lattice, over mu d [-]
  std::optional<CutErrors> from_local;  ///< from the local law at the same size
  std::optional<CutErrors> from_middle; ///< of "network": from the mean of "local" and "local-turned"
};

/// All comparisons in one state, laws in the order in which tables have them: "local", "local-nominal" (the
/// same in the sheet as a case describes it), "local-moved" (the same at the largest size, the rim or tip moved by what
/// its place is known to, twice), "local-turned" (likewise, the lattice turned by 30 degrees, theory-comparison.md, eq.
/// (H.17)), "network" and "network-gradient" (at the largest size and those of `other_sizes`), "lattice", "isotropic",
/// "mooney-rivlin". Collective.
/// @throws std::runtime_error if a lattice does not relax, unless the study is only reported
std::vector<CutResult> compare_sizes(const bridge::Subject &subject, const CutStudy &study, const Eigen::Matrix2d &F);

/// The part of the claim `prestretch` on inhomogeneous fields: rows for each state, and a table named after
/// the study with a row for each size and law (reference-files.md). Rows fail where a lattice does not relax, or a
/// judged law has no equilibrium. Collective.
ClaimOutcome cut_claim(const bridge::Subject &subject, const CutStudy &study);

} // namespace latcon::claims
