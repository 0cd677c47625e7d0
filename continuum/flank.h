#pragma once

#include "continuum/lattice_gradient.h"
#include "continuum/material.h"
#include "continuum/sheet.h"
#include "continuum/viscosity.h"

#include <memory>
#include <vector>

namespace latcon::continuum
{
/// Laws of a half sheet along whose lower edge a crack opens, without the bonds and dashpots that the crack has cut. In
/// the Voronoi cells of a lattice, half of the bonds of direction N and length l [m] are missing to the depth |N_2| l
/// from a free flank (theory-comparison.md, eq. (H.31)).
class Flank
{
public:
  /// Where bonds are missing: X[0] in (start, tip), to the depth of a layer above the axis [m].
  struct Layers
  {
    double axis, start, tip;
    std::vector<double> depths; ///< ascending, above 0

    /// Returns the number of the first layer that contains X, and depths.size() where no bond is missing.
    std::size_t at(const dealii::Point<2> &X) const;
  };

  /// Creates the laws of a sheet that is not cut yet, whose crack starts at X = (start, axis) [m]. The whole laws must
  /// outlive them.
  /// @param pitch distance of lines of sites along the crack [m]
  /// @param viscosity nullptr: none @throws std::bad_cast unless it is a FibreViscosity
  Flank(double axis, double start, double pitch, const std::vector<BondFamily> &bonds, const Material &whole,
        const Viscosity *viscosity);

  /// Moves the tip to X [m], between two steps of a motion that uses the laws.
  void cut_to(double X) { layers_->tip = X; }

  /// Moves the tip likewise in a motion of `sheet`, which uses the laws and is displaced by u. Returns the energy of the
  /// bonds that are cut [J/m].
  double cut_to(double X, const Sheet &sheet, const Sheet::Vector &u);

  const Material &law() const { return *law_; }
  const std::shared_ptr<const Viscosity> &viscosity() const { return viscosity_; } ///< nullptr: none

private:
  std::shared_ptr<Layers> layers_;
  std::shared_ptr<const Material> law_;
  std::shared_ptr<const Viscosity> viscosity_;
};
} // namespace latcon::continuum
