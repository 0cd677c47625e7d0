#include "verification/output/damage_record.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "lattice/archive_rows.h"
#include "verification/output/crack_json.h"
#include "verification/output/csv.h"
#include "verification/output/output_file.h"

namespace latcon::output
{

DamageRecord::DamageRecord(const input::Case &input, const continuum::DamageMotion &motion, const double seed_tip)
  : input_(input), motion_(motion), seed_tip_(seed_tip),
    column_(static_cast<std::size_t>(std::floor(seed_tip / motion.grid().size_x))), tip_(input.spacing, input.length)
{
}

analysis::DamageImage DamageRecord::image() const
{
  const continuum::NodeGrid &grid = motion_.grid();
  return {grid.columns(), grid.rows(), grid.size_x, grid.size_y, grid.bottom, &motion_.damage().nodal()};
}

void DamageRecord::step()
{
  const std::optional<analysis::ContourTip> tip = analysis::contour_tip(image(), column_);
  if (!tip || (!tip_.records().empty() && tip->column == column_))
    return;
  column_ = tip->column;
  const continuum::NodeGrid &grid = motion_.grid();
  const double X = tip->X, Y = tip->Y;
  // Displacement between the nodes of a cell.
  const double along = std::min(X / grid.size_x, static_cast<double>(grid.cells_x) - 1e-9);
  const double across = std::min((Y - grid.bottom) / grid.size_y, static_cast<double>(grid.cells_y) - 1e-9);
  const double p = along - std::floor(along), q = across - std::floor(across);
  const std::size_t a = static_cast<std::size_t>(across) * grid.columns() + static_cast<std::size_t>(along);
  const std::size_t up = grid.columns();
  Eigen::Vector2d x = input_.deformation() * Eigen::Vector2d(X, Y);
  for (const int axis : {0, 1})
  {
    const std::vector<double> &u = motion_.displacement()[static_cast<std::size_t>(axis)];
    x(axis) += (1. - q) * ((1. - p) * u[a] + p * u[a + 1]) + q * ((1. - p) * u[a + up] + p * u[a + up + 1]);
  }
  tip_.add({motion_.time(), X, Y, x.x(), x.y()});
}

void DamageRecord::energies()
{
  energies_.add(motion_.time(), motion_.ledger());
}

double DamageRecord::mean_speed() const
{
  return motion_.time() > 0. && !tip_.records().empty() ? (tip_.X() - tip_.records().front().X) / motion_.time() : 0.;
}

double DamageRecord::imbalance() const
{
  return energies_.imbalance(
    [](double time, const continuum::DamageMotionLedger &e) {
      return LedgerState{time, e.elastic + e.gradient, e.kinetic, e.viscous, e.fracture, e.shed, 0., e.imbalance};
    });
}

analysis::CrackMeasurement DamageRecord::measure() const
{
  const std::vector<analysis::ContourColumn> columns = analysis::contour(image(), seed_tip_);
  analysis::CrackMeasurementOptions options;
  options.strip_length = input_.length;
  options.lattice_spacing = input_.spacing;
  options.end_time = motion_.time();
  options.seed_tip_X = seed_tip_;
  // At most that of a tip on nodes; the contour is interpolated between them.
  options.position_error *= motion_.grid().size_y / input_.spacing;
  return analysis::measure_path(
    tip_.records(),
    [&](double X_begin, double X_end)
    { return analysis::branched_fraction(columns, X_begin, X_end, input_.spacing, options.branch_rule); },
    options);
}

void DamageRecord::write_tables(const std::filesystem::path &directory) const
{
  write_file(directory / "crack.csv", tip_.csv(false));
  Table edges({"X", "strands", "lower", "upper", "damaged"});
  for (const analysis::ContourColumn &column : analysis::contour(image(), seed_tip_))
    edges.add({column.X, column.n_strands, column.lower, column.upper, column.damaged});
  write_file(directory / "crack_edges.csv", edges.csv());
  // Columns of the lattice's table, whose edges do no work here either, and whose cracks do not touch themselves here.
  write_file(
    directory / "energy.csv",
    energies_.csv(
      {"elastic", "kinetic", "viscous", "broken", "boundary_work", "contact", "shed", "imbalance", "gradient"},
      [](const continuum::DamageMotionLedger &e) {
        return std::array{e.elastic + e.gradient, e.kinetic, e.viscous, e.fracture, 0., 0., e.shed, e.imbalance,
                          e.gradient};
      }));
}

void DamageRecord::write_measurement(const std::filesystem::path &directory,
                                     const analysis::CrackMeasurement &measurement, const bool skip_verification) const
{
  nlohmann::ordered_json json = crack_json(measurement);
  const analysis::CrackMeasurementOptions options;
  const std::optional<analysis::ContourMeasurement> contour =
    analysis::measure_contour(analysis::contour(image(), seed_tip_), measurement.X_begin, measurement.X_end,
                              input_.spacing, options.min_wavelength);
  using Json = nlohmann::ordered_json;
  json["width"] = contour ? Json(contour->mean_width) : Json(nullptr);
  json["width_rms"] = contour ? Json(contour->rms_width) : Json(nullptr);
  json["centre_rms"] = contour ? Json(contour->rms_centre) : Json(nullptr);
  json["several_strands"] = contour ? Json(contour->several_strands) : Json(nullptr);
  const auto put = [&](const std::string &line, std::optional<analysis::SinusoidFit> analysis::ContourMeasurement::*fit)
  {
    const std::optional<analysis::SinusoidFit> found = contour ? (*contour).*fit : std::nullopt;
    json[line + "_wavelength"] = found ? Json(found->wavelength.value) : Json(nullptr);
    json[line + "_amplitude"] = found ? Json(found->amplitude.value) : Json(nullptr);
    json[line + "_log_evidence"] = found ? Json(found->log_evidence) : Json(nullptr);
  };
  put("centre", &analysis::ContourMeasurement::centre);
  put("lower_edge", &analysis::ContourMeasurement::lower);
  put("upper_edge", &analysis::ContourMeasurement::upper);
  put("width", &analysis::ContourMeasurement::width);
  json["side"] = "continuum";
  json["end_time"] = motion_.time();
  json["energy_imbalance"] = imbalance();
  json["skip_verification"] = skip_verification;
  json["units"] = "speeds m/s, lengths m in the undeformed sheet, time s; uncertainties are one standard deviation";
  write_file(directory / "crack.json", json.dump(2) + "\n");
}

} // namespace latcon::output
