#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "lattice/simulation.h"
#include "verification/analysis/crack_measurement.h"
#include "verification/analysis/near_tip_measurement.h"
#include "verification/input/case.h"

namespace latcon::output
{

/// Speeds of long waves along x in the loaded sheet, dashpots left out (theory-comparison.md, eq. (W.2)).
struct WaveSpeeds
{
  double longitudinal, shear; ///< referential [m/s]: of the laboratory over the stretch along x
};

/// Of the sheet of a case in its loaded state.
WaveSpeeds wave_speeds_along_crack(const input::Case &input);

/// Time between samples [s]; 0: none are taken. The default is d / (2 c_S), c_S the speed of long shear waves in the
/// undeformed sheet: at about that speed a crack advances half a spacing between two samples, with any time step.
double near_tip_interval(const input::Case &input);

/// Area of the window around the tip, undeformed [m^2].
double near_tip_window(const input::Case &input);

/// The fields around the tip of a fracture run, and what is measured of them.
///
/// Samples are taken while the tip is between 40 and 90 % of the way from the seed to the stop position: the crack has
/// forgotten the seed, and the held edge behind the stop is far.
class NearTipRecord
{
public:
  /// @param seed_tip_X of the seed crack, reference [m]
  NearTipRecord(const input::Case &input, lattice::Simulation &simulation, double seed_tip_X);

  /// To be called after every step; takes a sample after the first step that ends in another interval of time than the
  /// one before. Collective; the first rank takes the samples.
  void step();

  /// Writes near_tip.json and, if there are samples, near_tip.vti and near_tip_folded.vti; nothing if no samples were
  /// asked for. To be called once, at the end, on the first rank. @throws OutputError,
  /// support::OutputError
  void write(const std::filesystem::path &directory, const analysis::CrackMeasurement &crack);

  /// Saves or loads what the samples said; see lattice::Simulation. The first rank's is the whole.
  /// @throws std::invalid_argument if it is not of as many samples as were taken
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
  /// Sums over the samples of a block of what single samples say.
  struct Sum
  {
    double value = 0.;
    std::size_t samples = 0;
    void add(double number)
    {
      value += number;
      ++samples;
    }
    template <class Archive>
    void archive(Archive &archive)
    {
      archive("value", value);
      archive("samples", samples);
    }
  };
  struct Block
  {
    Sum asymmetry, negative_zone_depth, wedge_angle;
    // Of each sample; which of them count is known at the end, with the speed of the crack.
    std::vector<std::vector<double>> vortices;         ///< their speeds [m/s]
    std::vector<std::vector<double>> backward_speeds;  ///< see backward_speeds()
    std::vector<std::vector<double>> following_speeds; ///< see speeds_behind_tip()

    template <class Archive>
    void archive(Archive &archive)
    {
      archive("asymmetry", asymmetry);
      archive("negative_zone_depth", negative_zone_depth);
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
  double intervals_ = 0.; // whole intervals until now
  Eigen::Matrix2d deformation_;
  double far_opening_stress_; // Cauchy sigma_yy of the loaded sheet [Pa]
  WaveSpeeds waves_;
  double X_begin_, X_end_;
  analysis::NearTipSampler sampler_;
  std::array<Block, analysis::NearTipSampler::n_blocks> blocks_;
};

} // namespace latcon::output
