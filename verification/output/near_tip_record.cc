#include "verification/output/near_tip_record.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include <nlohmann/json.hpp>

#include "verification/bridge/plane_waves.h"
#include "verification/bridge/small_strain.h"
#include "verification/output/field_writer.h"
#include "verification/output/output_file.h"

namespace latcon::output
{
namespace
{

// Distance that a shear wave of the undeformed sheet travels between two samples [d].
constexpr double sampled_advance = 0.5;
// Default extent of the window [d]: contains the wake over several process zones, both lobes of the opening stress, and
// the waves ahead.
constexpr double default_behind = 40., default_ahead = 32., default_half_height = 32.;
// Fractions of the distance from the seed to the stop position between which samples are taken.
constexpr double sampled_from = 0.4, sampled_to = 0.9;
// Range behind the tip in which straight lines are fitted to the flanks [d].
constexpr double flanks_from = 5., flanks_to = 25.;
constexpr double tip_loop = 8.; // radius [d]
// Smallest speed of a vortex as a fraction of the crack speed: ten times the noise of single sites ahead of a running
// tip.
constexpr double vortex_limit = 2e-3;
// Largest distance of vortices in samples [d]: the zone of negative velocity extends to 10 d, and there is little
// motion beyond 16 d.
constexpr double vortices_within = 16.;
// Fraction of the speed of fully relaxed material, c - C (theory.md, section "Near the tip"), above which material
// belongs to the process zone, for its length and its share.
constexpr double process_zone_part = 0.5;

// Deformation of the sheet in which the crack runs: the last one of a history.
Eigen::Matrix2d loaded(const input::Case &input)
{
  return input.history.deformations(input.deformation()).back();
}

analysis::NearTipOptions sampler_options(const input::Case &input, double X_begin, double X_end)
{
  const auto extent = [&](double stated, double spacings) { return stated > 0. ? stated : spacings * input.spacing; };
  return {extent(input.near_tip_behind, default_behind),
          extent(input.near_tip_ahead, default_ahead),
          extent(input.near_tip_half_height, default_half_height),
          X_begin,
          X_end,
          loaded(input)};
}

// Returns the number of `speeds` above a limit.
double number_above(const std::vector<double> &speeds, double limit)
{
  return static_cast<double>(std::count_if(speeds.begin(), speeds.end(), [&](double speed) { return speed > limit; }));
}

// Returns the fraction of `speeds` above a limit; none if there are no speeds.
std::optional<double> share_above(const std::vector<double> &speeds, double limit)
{
  if (speeds.empty())
    return std::nullopt;
  return number_above(speeds, limit) / static_cast<double>(speeds.size());
}

// Returns a member of an object, or a function of it; none without the object.
template <class Object, class Part>
std::optional<double> part_of(const std::optional<Object> &object, const Part &part)
{
  return object ? std::optional<double>(std::invoke(part, *object)) : std::nullopt;
}

using Number = std::pair<std::string, std::optional<double>>;

// Returns the measurements of a mean field. The names are always the same; numbers that depend on the speed of the
// crack have no value without it.
std::vector<Number> field_numbers(const analysis::NearTipField &field, std::optional<double> laboratory_speed,
                                  std::optional<double> process_zone_speed, double far_opening_stress, double spacing)
{
  std::vector<Number> numbers;
  const auto add = [&](const std::string &name, const std::optional<double> &value)
  { numbers.emplace_back(name, value); };
  std::optional<analysis::NegativeZone> negative;
  std::optional<std::vector<analysis::Vortex>> vortices;
  if (laboratory_speed)
  {
    negative = analysis::negative_zone(field, *laboratory_speed);
    vortices = analysis::vortices(field, vortex_limit * *laboratory_speed);
  }
  add("negative_zone_area", part_of(negative, &analysis::NegativeZone::area));
  add("negative_zone_length", part_of(negative, &analysis::NegativeZone::length));
  add("negative_zone_distance", part_of(negative, &analysis::NegativeZone::distance));
  add("negative_zone_depth", part_of(negative, &analysis::NegativeZone::depth));
  add("negative_zone_depth_X", part_of(negative, [](const auto &zone) { return zone.deepest.x(); }));
  add("negative_zone_depth_Y", part_of(negative, [](const auto &zone) { return zone.deepest.y(); }));
  add("velocity_asymmetry", analysis::velocity_asymmetry(field));
  add("vortices", part_of(vortices, [](const auto &all) { return static_cast<double>(all.size()); }));
  std::optional<analysis::Vortex> nearest;
  if (vortices && !vortices->empty())
    nearest = vortices->front();
  add("vortex_distance", part_of(nearest, [](const auto &vortex) { return vortex.position.norm(); }));
  add("vortex_circulation", part_of(nearest, &analysis::Vortex::circulation));
  add("tip_circulation", analysis::circulation(field, Eigen::Vector2d::Zero(), tip_loop * spacing, true));
  std::optional<analysis::FollowingZone> process;
  if (process_zone_speed)
    process = analysis::following_zone(field, *process_zone_speed);
  add("process_zone_length", part_of(process, &analysis::FollowingZone::length));
  add("process_zone_fastest", part_of(process, &analysis::FollowingZone::fastest));
  add("process_zone_share", part_of(process_zone_speed, [&](double speed)
                                    { return share_above(analysis::speeds_behind_tip(field), speed); }));
  for (const int radius : {4, 8})
  {
    const std::optional<analysis::OpeningStress> stress = analysis::opening_stress(field, radius * spacing);
    const std::string at = "_" + std::to_string(radius) + "d";
    add("opening_stress_angle" + at, part_of(stress, &analysis::OpeningStress::angle));
    add("opening_stress_ratio" + at, part_of(stress, &analysis::OpeningStress::ratio));
    add("opening_stress_peak" + at, part_of(stress, &analysis::OpeningStress::peak));
    const bool known = stress && far_opening_stress > 1e-9 * stress->peak; // by more than round-off
    add("opening_stress_concentration" + at, known ? std::optional(stress->peak / far_opening_stress) : std::nullopt);
  }
  return numbers;
}

// Returns the Cauchy stress of the loaded sheet [Pa], evaluated at a site in the middle of a homogeneously deformed
// sheet whose bonds have their mean stiffness.
Eigen::Matrix2d stress_of_loaded_sheet(const input::Case &input)
{
  input::Case piece = input;
  piece.length = piece.height = 12. * input.spacing;
  piece.nonlocal.scatter = 0.; // of the mean over all points
  const lattice::TriangularLattice sheet = piece.sheet();
  lattice::Material material = input.material();
  material.disorder = {};
  const lattice::RowPartition whole(sheet);
  const lattice::State state = lattice::homogeneous_state(whole, material, loaded(input), {true, true, true, true});
  const std::size_t row = sheet.rows() / 2;
  return lattice::site_values(state, sheet, material, sheet.index(row, sheet.sites_in_row(row) / 2)).cauchy_stress;
}

// Returns the standard deviation of the mean over all blocks, estimated from those of blocks that have one; none for
// fewer than two.
std::optional<double> uncertainty(const std::vector<double> &means)
{
  const double n = static_cast<double>(means.size()), mean = std::accumulate(means.begin(), means.end(), 0.) / n;
  if (n < 2.)
    return std::nullopt;
  double squares = 0.;
  for (const double of_block : means)
    squares += std::pow(of_block - mean, 2);
  return std::sqrt(squares / ((n - 1.) * n));
}

// Returns the speeds of long waves along x in the loaded sheet, without dashpots (theory-comparison.md, eq. (W.2)):
// longitudinal and shear, referential [m/s], the laboratory speeds divided by the stretch along x.
std::array<double, 2> wave_speeds_along_crack(const input::Case &input)
{
  constexpr double kd = 1e-3; // relative error of about kd^2 / 10
  const double k = kd / input.spacing;
  input::Case regular = input;
  regular.nonlocal.scatter = 0.;
  const auto waves = bridge::bloch_waves(regular.sheet(), input.material(), loaded(input), {k, 0.});
  return {waves[0].frequency / k, waves[1].frequency / k};
}

} // namespace

double near_tip_interval(const input::Case &input)
{
  return input.near_tip_interval.value_or(sampled_advance * input.spacing /
                                          bridge::small_strain(input.lattice(), input.material()).shear_speed);
}

double near_tip_window(const input::Case &input)
{
  const analysis::NearTipOptions window = sampler_options(input, 0., 0.);
  return (window.behind + window.ahead) * 2. * window.half_height;
}

NearTipRecord::NearTipRecord(const input::Case &input, lattice::Simulation &simulation, double seed_tip_X)
  : simulation_(simulation), interval_(near_tip_interval(input)), deformation_(loaded(input)),
    far_opening_stress_(stress_of_loaded_sheet(input)(1, 1)), wave_speeds_(wave_speeds_along_crack(input)),
    X_begin_(seed_tip_X + sampled_from * (input.stop_position * simulation.lattice().length() - seed_tip_X)),
    X_end_(seed_tip_X + sampled_to * (input.stop_position * simulation.lattice().length() - seed_tip_X)),
    sampler_(simulation.lattice(), simulation.material(), sampler_options(input, X_begin_, X_end_))
{
}

void NearTipRecord::check_loaded() const
{
  std::size_t samples = 0;
  for (const Block &block : blocks_)
  {
    const std::size_t n = block.backward_speeds.size();
    samples += n;
    support::require(block.vortices.size() == n && block.following_speeds.size() == n && block.asymmetry.size() <= n &&
                       block.wedge_angle.size() <= n,
                     "`blocks` have different numbers of samples");
  }
  support::require(samples == sampler_.samples(), "the number of samples in `blocks` does not match the number taken");
}

void NearTipRecord::step()
{
  if (interval_ == 0.)
    return;
  const double intervals = std::floor(simulation_.state().time / interval_);
  if (intervals == intervals_)
    return;
  intervals_ = intervals;
  if (!simulation_.tip())
    return;
  const std::size_t tip = *simulation_.tip();
  if (sampler_.samples_at(tip))
    simulation_.gather(sampler_.rows_around(tip));
  if (!simulation_.band().is_first())
    return;
  const analysis::NearTipSample *sample = sampler_.sample(simulation_.state(), tip);
  if (sample == nullptr)
    return;
  const double d = simulation_.lattice().lattice_spacing();
  Block &block = blocks_[sample->block];
  const analysis::NearTipField field = sample->sums.mean();
  if (const auto asymmetry = analysis::velocity_asymmetry(field))
    block.asymmetry.push_back(*asymmetry);
  block.backward_speeds.push_back(analysis::backward_speeds(field));
  block.following_speeds.push_back(analysis::speeds_behind_tip(field));
  block.vortices.emplace_back();
  for (const analysis::Vortex &vortex : analysis::vortices(field, 0., vortices_within * d))
    block.vortices.back().push_back(vortex.speed);
  const Eigen::Vector2d pitch(deformation_(0, 0) * sampler_.grid().pitch_X,
                              deformation_(1, 1) * sampler_.grid().pitch_Y);
  const double stretch = deformation_(0, 0);
  if (const auto angle =
        analysis::wedge_angle(sample->sites, pitch, flanks_from * d * stretch, flanks_to * d * stretch))
    block.wedge_angle.push_back(*angle * 180. / M_PI);
}

void NearTipRecord::write(const std::filesystem::path &directory, const analysis::CrackMeasurement &crack)
{
  if (interval_ == 0.)
    return;
  sampler_.finish();
  if (sampler_.samples() > 0)
  {
    write_near_tip_field(sampler_.plain(), directory / "near_tip.vti");
    write_near_tip_field(sampler_.folded(), directory / "near_tip_folded.vti");
  }
  write_file(directory / "near_tip.json", measurements(crack));
}

std::string NearTipRecord::measurements(const analysis::CrackMeasurement &crack) const
{
  nlohmann::ordered_json json;
  const auto put = [&json](const std::string &name, const std::optional<double> &value)
  { json[name] = value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(); }; // null also if it is not finite
  const auto put_measured =
    [&](const std::string &name, const std::optional<double> &value, const std::optional<double> &deviation)
  {
    put(name, value);
    put(name + "_uncertainty", value ? deviation : std::nullopt);
  };

  json["samples"] = sampler_.samples();
  json["reason"] = sampler_.samples() == 0 ? "the crack did not run through the interval in which samples are taken"
                   : !crack.speed_laboratory
                     ? "the speed of the crack, and quantities relative to it, could not be measured"
                     : "";
  json["sampled_from"] = X_begin_;
  json["sampled_to"] = X_end_;

  const double d = simulation_.lattice().lattice_spacing();
  std::optional<double> laboratory_speed = part_of(crack.speed_laboratory, &analysis::Measured::value),
                        process_zone_speed;
  // Fraction of the speed of fully relaxed rubber behind a steady crack (theory.md, eq. (N.1)).
  if (laboratory_speed && deformation_(0, 0) > 1.)
    process_zone_speed = process_zone_part * (1. - 1. / deformation_(0, 0)) * *laboratory_speed;

  std::vector<std::vector<Number>> of_blocks;
  for (std::size_t block = 0; block < blocks_.size(); ++block)
    if (sampler_.folded_block(block).samples() > 0)
      of_blocks.push_back(field_numbers(sampler_.folded_block(block).mean(), laboratory_speed, process_zone_speed,
                                        far_opening_stress_, d));
  if (sampler_.samples() == 0)
    laboratory_speed = process_zone_speed = std::nullopt; // without samples nothing is measured, not even 0
  const std::vector<Number> numbers =
    field_numbers(sampler_.folded(), laboratory_speed, process_zone_speed, far_opening_stress_, d);
  for (std::size_t n = 0; n < numbers.size(); ++n)
  {
    std::vector<double> values;
    for (const std::vector<Number> &block : of_blocks)
      if (block[n].second)
        values.push_back(*block[n].second);
    put_measured(numbers[n].first, numbers[n].second, uncertainty(values));
  }
  // Adds the mean over samples of the values of each block.
  const auto put_means = [&](const std::string &name, const auto &values_of)
  {
    double sum = 0.;
    std::size_t n = 0;
    std::vector<double> means;
    for (const Block &block : blocks_)
      if (const std::vector<double> values = values_of(block); !values.empty())
      {
        const double of_block = std::accumulate(values.begin(), values.end(), 0.);
        sum += of_block;
        n += values.size();
        means.push_back(of_block / static_cast<double>(values.size()));
      }
    put_measured(name, n > 0 ? std::optional<double>(sum / static_cast<double>(n)) : std::nullopt, uncertainty(means));
  };
  put_means("velocity_asymmetry_of_samples", [](const Block &block) { return block.asymmetry; });
  // The same of a function of the speeds stored per sample; no value without their threshold.
  const auto put_speeds =
    [&](const std::string &name, auto speeds_of, const std::optional<double> &needed, auto value_of)
  {
    put_means(name,
              [&](const Block &block)
              {
                std::vector<double> values;
                if (needed)
                  for (const std::vector<double> &speeds : block.*speeds_of)
                    if (const std::optional<double> value = value_of(speeds))
                      values.push_back(*value);
                return values;
              });
  };
  put_speeds("negative_zone_depth_of_samples", &Block::backward_speeds, 0.,
             [](const auto &speeds) { return speeds.empty() ? 0. : *std::min_element(speeds.begin(), speeds.end()); });
  const auto turning = [&](const auto &speeds) { return number_above(speeds, vortex_limit * *laboratory_speed); };
  put_speeds("vortices_of_samples", &Block::vortices, laboratory_speed, turning);
  put_speeds("samples_with_vortex", &Block::vortices, laboratory_speed,
             [&](const auto &speeds) { return turning(speeds) > 0. ? 1. : 0.; });
  const double site_area = sampler_.grid().pitch_X * sampler_.grid().pitch_Y;
  put_speeds("negative_zone_area_of_samples", &Block::backward_speeds, laboratory_speed,
             [&](const auto &speeds)
             {
               const double limit = -analysis::negative_zone_limit * *laboratory_speed;
               return site_area * static_cast<double>(std::count_if(speeds.begin(), speeds.end(),
                                                                    [&](double speed) { return speed < limit; }));
             });
  put_speeds("process_zone_share_of_samples", &Block::following_speeds, process_zone_speed,
             [&](const auto &speeds) { return share_above(speeds, *process_zone_speed); });
  put_means("wedge_angle", [](const Block &block) { return block.wedge_angle; });
  put("process_zone_speed", process_zone_speed);
  put("far_opening_stress", far_opening_stress_);
  put("longitudinal_speed", wave_speeds_[0]);
  put("shear_speed", wave_speeds_[1]);
  const auto put_ratio = [&](const std::string &name, double wave)
  {
    const auto over = [&](double analysis::Measured::*number)
    { return part_of(crack.speed_lagrangian, [&](const auto &speed) { return speed.*number / wave; }); };
    put_measured(name, over(&analysis::Measured::value), over(&analysis::Measured::uncertainty));
  };
  put_ratio("speed_over_longitudinal", wave_speeds_[0]);
  put_ratio("speed_over_shear", wave_speeds_[1]);
  json["units"] =
    "lengths m, areas m^2, wave speeds m/s in the undeformed sheet; velocities m/s of the laboratory; "
    "circulations m^2/s in the current sheet; stresses Pa (Cauchy); angles degrees, that of the peak stress "
    "undeformed, of the wedge current; uncertainties are one standard deviation of the mean";
  return json.dump(2) + "\n";
}

} // namespace latcon::output
