#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "lattice/simulation.h"
#include "verification/analysis/crack_measurement.h"
#include "verification/analysis/near_tip_measurement.h"
#include "verification/input/case.h"

namespace latcon::output
{

/// Returns the time between samples [s]; 0: no samples. The default is d / (2 c_S), with the speed c_S of long shear
/// waves in the undeformed sheet: a crack at about that speed advances half a spacing between two samples, for any time
/// step.
double near_tip_interval(const input::Case &input);

/// Returns the area of the window around the tip, reference [m^2].
double near_tip_window(const input::Case &input);

/// Record of the fields around the tip of a fracture run, and measurements of them.
///
/// Samples are taken while the tip is between 40 and 90 % of the distance from the seed to the stop position, where
/// neither the seed nor the held edge behind the stop position influences the crack.
class NearTipRecord
{
public:
  /// Creates a record. @param seed_tip_X reference X of the tip of the seed [m]
  NearTipRecord(const input::Case &input, lattice::Simulation &simulation, double seed_tip_X);

  /// Takes a sample if this step is the first to end in another time interval than the step before. To be called after
  /// every step. Collective; the root rank takes the samples.
  void step();

  /// Writes near_tip.json and, if there are samples, near_tip.vti and near_tip_folded.vti; nothing if samples are
  /// disabled. To be called once, at the end, on the root rank. @throws support::OutputError
  void write(const std::filesystem::path &directory, const analysis::CrackMeasurement &crack);

  /// Saves or loads the record; see lattice::Simulation. The root rank has the complete record.
  /// @throws std::invalid_argument if the numbers of samples do not match
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("intervals", intervals_);
    archive("sampler", sampler_);
    archive("blocks", blocks_);
    if constexpr (Archive::loads)
      check_loaded();
  }

private:
  struct Block
  {
    std::vector<double> asymmetry, wedge_angle; ///< of samples that have one
    // Per sample. The thresholds on these speeds are known at the end, with the speed of the crack.
    std::vector<std::vector<double>> vortices;         ///< speeds of vortices [m/s]
    std::vector<std::vector<double>> backward_speeds;  ///< see backward_speeds()
    std::vector<std::vector<double>> following_speeds; ///< see speeds_behind_tip()

    template <class Archive>
    void archive(Archive &archive)
    {
      archive("asymmetry", asymmetry);
      archive("wedge_angle", wedge_angle);
      archive("vortices", vortices);
      archive("backward_speeds", backward_speeds);
      archive("following_speeds", following_speeds);
    }
  };
  void check_loaded() const;
  std::string measurements(const analysis::CrackMeasurement &crack) const;

  lattice::Simulation &simulation_;
  double interval_;       // [s], 0: no samples
  double intervals_ = 0.; // number of complete intervals
  Eigen::Matrix2d deformation_;
  double far_opening_stress_; // Cauchy sigma_yy of the loaded sheet [Pa]
  std::array<double, 2> wave_speeds_; // longitudinal and shear, of long waves along x in the loaded sheet [m/s]
  double X_begin_, X_end_;
  analysis::NearTipSampler sampler_;
  std::array<Block, analysis::NearTipSampler::n_blocks> blocks_;
};

} // namespace latcon::output
