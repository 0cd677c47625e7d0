#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lattice/state.h"
#include "support/require.h"
#include "verification/analysis/near_tip_fields.h"

namespace latcon::output
{

/// Fields of a frame of the lattice.
enum class FrameFields
{
  all,
  motion ///< displacement and velocity at the sites, in single precision: a tenth of the size, for animations
};

/// Writes frames of a lattice for ParaView: `NAME.pvd`, and a file `NAME-NNNN.vtp` per frame, in one directory.
///
/// Points are the sites at their reference positions [m]; warp by `displacement` for the current ones. Cells are the
/// sites themselves (vertices) and the bonds (lines). Point data: displacement [m], velocity [m/s],
/// deformation_gradient [-], first_piola_stress [Pa], cauchy_stress [Pa], strain_gradient_x and _y [1/m] (NaN where the
/// remaining bonds do not determine it, see StrainGradientFit), strain_energy_density [J/m^3], damage [-], held, site
/// (row-wise number), fragment (0 the sheet, 1, 2 ... detached, see Fragments). Cell data: stretch [-] (at a vertex the
/// mean over its bonds, 1 without bonds), shell (0 vertex, 1 nearest, 2 next-nearest, 3 third-nearest), toughened (0 or
/// 1); bonds across a periodic edge are omitted. The field data arrays TimeValue and SheetBounds hold the time [s] and
/// the bounds of the undeformed sheet (of one period if it is periodic): X from, to, Y from, to [m]. Quantities have
/// their units (VTK's UNITS_LABEL). Every file is replaced atomically.
class FieldWriter
{
public:
  /// Creates a writer. The lattice must outlive this object.
  FieldWriter(const lattice::TriangularLattice &lattice, const lattice::Material &material,
              std::filesystem::path directory, std::string name = "lattice", FrameFields fields = FrameFields::all);

  /// Adds the state as the next frame; in place of frames that are not earlier. @throws support::OutputError if
  /// a file cannot be written
  void add_frame(const lattice::State &state);

  /// Writes `NAME.pvd` with the current list of frames. @throws support::OutputError
  void write_collection() const;

  /// Returns the times of the frames [s].
  const std::vector<double> &times() const { return times_; }

  /// Saves or loads the list of frames; see Simulation. @throws std::invalid_argument if their times do not increase
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("times", times_);
    if constexpr (Archive::loads)
      support::require(std::adjacent_find(times_.begin(), times_.end(), std::greater_equal<>()) == times_.end() &&
                         (times_.empty() || times_.front() >= 0.),
                       "`times` of frames do not increase from 0");
  }

private:
  std::string file_name(std::size_t frame) const;

  const lattice::TriangularLattice &lattice_;
  lattice::Material material_;
  std::filesystem::path directory_;
  std::string name_;
  FrameFields fields_;
  std::vector<double> times_; // of the frames [s]
};

/// Writes the means around a tip as an image for ParaView (.vti), which replaces `path` atomically.
///
/// Points are those of the grid, in the reference configuration relative to the tip [m]; warp by `displacement` for the
/// current one. Arrays, units and index order as in FieldWriter, and in addition excess_displacement [m],
/// strain_gradient_x, strain_gradient_y [1/m] and occupancy [-]; NaN at points without a site. The field data array
/// Samples is the number of samples.
/// @throws support::OutputError if the file cannot be written
void write_near_tip_field(const analysis::NearTipField &field, const std::filesystem::path &path);

} // namespace latcon::output
