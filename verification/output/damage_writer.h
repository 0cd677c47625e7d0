#pragma once

#include "continuum/damage/damage_motion.h"
#include "verification/output/frame_series.h"

namespace latcon::output
{

/// Frames of a continuum that breaks: `continuum.pvd` and a file `continuum-NNNN.vtp` each, the quadrilaterals of the
/// grid with displacement [m], velocity [m/s], damage [-] and strain_energy_density [J/m^3], the degraded one, at the
/// nodes. In single precision.
class DamageWriter
{
public:
  /// @param loading F_0 [-] about which the motion counts its displacement; frames have that of the undeformed sheet
  DamageWriter(std::filesystem::path directory, const dealii::Tensor<2, 2> &loading);

  /// Adds a frame, or replaces the last one if it has the same time. @throws support::OutputError
  void add_frame(const continuum::DamageMotion &motion);

  const FrameSeries &series() const { return series_; }

  template <class Archive>
  void archive(Archive &archive)
  {
    series_.archive(archive);
  }

private:
  FrameSeries series_;
  dealii::Tensor<2, 2> loading_;
};

} // namespace latcon::output
