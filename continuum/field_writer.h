#pragma once

#include "continuum/dynamic_solver.h"
#include "continuum/sheet.h"

#include <filesystem>
#include <string>
#include <vector>

namespace latcon::continuum
{
/// Writes the fields of a sheet as a series that ParaView opens: NAME.pvd, and for each frame NAME_0000.vtu, or
/// NAME_0000.pvtu with a piece for each rank. Fields, over the reference configuration: `displacement` [m],
/// `deformation_gradient` [-], `first_piola_stress` [Pa], `cauchy_stress` [Pa] (per reference thickness, see
/// continuum::cauchy_stress), `strain_energy_density` [J/m^3], `strain_gradient_x`, `strain_gradient_y` (G_iJK [1/m] as
/// tensors in J and K for i = x and i = y), `double_stress_x`, `double_stress_y` (Q_iJK [Pa m] likewise), and in
/// dynamics `velocity` [m/s]. Stresses in dynamics include those of viscosity and Maxwell branches. Tensors have nine
/// components in row-major order (current index first). Cells are Lagrange cells of the degree of the elements.
///
/// Every file is replaced atomically, pieces before the files that refer to them, so that the series is readable at any
/// moment. Times are written in full precision.
class FieldWriter
{
public:
  /// Creates `directory` if it does not exist; its parent must exist. `name` is the NAME of the files. Collective.
  /// Throws OutputFailed on every rank.
  FieldWriter(MPI_Comm communicator, std::filesystem::path directory, std::string name = "continuum");

  /// Writes a frame with the state `u` (nodal displacement [m], with ghost entries) at the load factor `time` [-]. It
  /// must increase from frame to frame. Collective. Throws on every rank: OutputFailed, NonPhysicalState as the law
  /// does, InvalidInput if the time does not increase.
  /// `v` is the nodal velocity [m/s] (nullptr: none), and `rate_stresses` are those of DynamicSolver (empty: none).
  void add_frame(double time, const Sheet &sheet, const Sheet::Vector &u, const Sheet::Vector *v = nullptr,
                 const std::vector<dealii::Tensor<2, 2>> &rate_stresses = {});

  /// Writes a frame with the present state of a motion, at its time [s]. Otherwise as above.
  void add_frame(const DynamicSolver &solver);

  /// Saves the list of frames to an archive, or loads it so that later frames are appended. Throws InvalidInput if the
  /// loaded times do not increase.
  template <class Archive>
  void archive(Archive &archive)
  {
    archive.records("frames", frames_);
    for (std::size_t frame = 0; frame < frames_.size(); ++frame)
      require(frames_[frame].n_pieces > 0 && (frame == 0 || frames_[frame].time > frames_[frame - 1].time),
              "the stored times of frames do not increase, or a frame has no pieces");
  }

  /// Rewrites the .pvd with the frames in the list, in case the file refers to later frames as well. Collective. Throws
  /// OutputFailed on every rank.
  void write_collection() const;

  std::size_t n_frames() const { return frames_.size(); }

  /// Returns the time [s] or load factor [-] of the last frame; minus infinity before the first.
  double last_time() const;

  /// Returns the path of the .pvd.
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

  std::string frame_name(std::size_t frame) const;
  std::string file_of(std::size_t frame) const;

  MPI_Comm communicator_;
  std::filesystem::path directory_;
  std::string name_;
  std::vector<Frame> frames_;
};
} // namespace latcon::continuum
