#pragma once

#include "continuum/sheet.h"

#include <filesystem>
#include <string>
#include <vector>

namespace latcon::continuum
{
/// Writes the fields of a sheet as a series that ParaView opens: NAME.pvd, and for each frame NAME_0000.vtu, or
/// NAME_0000.pvtu with a piece for each rank. Fields, over the reference configuration: `displacement` [m],
/// `deformation_gradient` [-], `first_piola_stress` [Pa], `cauchy_stress` [Pa] (per reference thickness, see
/// continuum::cauchy_stress), `strain_energy_density` [J/m^3], and of the gradient G_iJK [1/m] and the double stress
/// Q_iJK [Pa m] the tensors in J and K for i = x and i = y: `strain_gradient_x`, `strain_gradient_y`,
/// `double_stress_x`, `double_stress_y`; in motion also `velocity` [m/s]. Tensors have nine components, index order row
/// by row (current index first). Cells are Lagrange cells of the degree of the elements.
///
/// Every file is written beside its place and renamed, pieces before the files that name them, so that what is there is
/// whole at any moment. Times are written with 17 significant digits.
class FieldWriter
{
public:
  /// Makes `directory` if it does not exist; the folder above it has to. Collective. Throws OutputFailed on every rank.
  FieldWriter(MPI_Comm communicator, std::filesystem::path directory, std::string name = "continuum");

  /// Adds the state `u` (nodal displacement [m], with ghost entries), and its velocity `v` [m/s] if given, at `time`,
  /// which must grow from frame to frame: the load factor [-] in statics, [s] in dynamics. Collective. Throws
  /// OutputFailed on every rank, and NonPhysicalState if the law does; InvalidInput if the time does not grow.
  void add_frame(double time, const Sheet &sheet, const Sheet::Vector &u, const Sheet::Vector *v = nullptr);

  /// Stores which frames there are, or takes that from there: those added later follow them. Throws InvalidInput if
  /// their times do not grow.
  template <class Archive>
  void archive(Archive &archive)
  {
    archive.records("frames", frames_);
    if constexpr (Archive::loads)
      check_loaded();
  }

  /// Writes the .pvd anew with the frames known, for one that names later frames as well. Collective. Throws
  /// OutputFailed on every rank.
  void write_collection() const;

  std::size_t n_frames() const { return frames_.size(); }

  /// Time of the last frame [s] or load factor [-]; minus infinity before the first.
  double last_time() const;

  /// Path of the .pvd.
  std::filesystem::path collection() const;

private:
  struct Frame
  {
    double time;          // [s] or load factor [-]
    std::size_t n_pieces; // files that the ranks wrote

    template <class Archive>
    void archive(Archive &archive)
    {
      archive("time", time);
      archive("pieces", n_pieces);
    }
  };

  void check_loaded() const;
  std::string file_of(std::size_t frame) const;

  MPI_Comm communicator_;
  std::filesystem::path directory_;
  std::string name_;
  std::vector<Frame> frames_;
};
} // namespace latcon::continuum
