#pragma once

#include "lattice/state.h"
#include "verification/output/frame_series.h"

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

  /// Adds the state as the next frame; replaces the last frame if it has the same time. @throws support::OutputError if
  /// a file cannot be written
  void add_frame(const lattice::State &state);

  const FrameSeries &series() const { return series_; }

  /// Saves or loads the list of frames; see Simulation.
  template <class Archive>
  void archive(Archive &archive)
  {
    series_.archive(archive);
  }

private:
  const lattice::TriangularLattice &lattice_;
  lattice::Material material_;
  FrameFields fields_;
  FrameSeries series_;
};

} // namespace latcon::output
