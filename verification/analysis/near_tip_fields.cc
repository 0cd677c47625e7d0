#include "verification/analysis/near_tip_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace latcon::analysis
{
namespace
{

// Range behind and ahead of a sample over which the path is averaged to find its direction [d].
constexpr double heading_from = 2.5, heading_to = 7.5;
// Number of calls after which an unmoved tip is at rest.
constexpr std::size_t calls_of_rest = 10;

// Interval of samples with stresses and gradients.
constexpr std::size_t samples_for_tensors = 4;

// Signs of components under the reflection Y -> -Y: -1 for components with an odd number of indices y, otherwise 1.
struct MirrorSigns
{
  NearTipSums::Motion motion;
  NearTipSums::Tensors tensors;
  NearTipSums::Gradients gradients;
};

const MirrorSigns &mirror_signs()
{
  static const MirrorSigns signs = []
  {
    MirrorSigns s;
    s.motion << 1, -1, 1, -1, 1, -1;
    s.tensors << 1, -1, -1, 1, 1, -1, -1, 1, 1, -1, -1, 1;
    s.gradients << 1, -1, 1, -1, 1, -1; // xXX, xXY, xYY, yXX, yXY, yYY
    return s;
  }();
  return signs;
}

template <typename Array>
Eigen::Vector2d vector_in(const Array &values, Eigen::Index first)
{
  return {values[first], values[first + 1]};
}

template <typename Array>
Eigen::Matrix2d tensor_in(const Array &values, Eigen::Index first)
{
  Eigen::Matrix2d tensor;
  tensor << values[first], values[first + 1], values[first + 2], values[first + 3];
  return tensor;
}

template <typename Array>
Eigen::Matrix2d symmetric_in(const Array &values, Eigen::Index first)
{
  Eigen::Matrix2d tensor;
  tensor << values[first], values[first + 1], values[first + 1], values[first + 2];
  return tensor;
}

NearTipGrid make_grid(const lattice::TriangularLattice &lattice, const NearTipOptions &options)
{
  const double d = lattice.spacing(), across = lattice.site_area() / d;
  NearTipGrid grid;
  const bool along = lattice.orientation() == lattice::Orientation::rows_along_crack;
  grid.pitch_X = along ? d : across;
  grid.pitch_Y = along ? across : d;
  const auto points = [](double extent, double pitch)
  {
    if (!(extent >= pitch && extent < 1e9 * pitch))
      throw std::invalid_argument("the window around the tip must cover at least one and fewer than 1e9 lattice rows");
    return static_cast<int>(std::floor(extent / pitch * (1. + 1e-12)));
  };
  grid.behind = points(options.behind, grid.pitch_X);
  grid.ahead = points(options.ahead, grid.pitch_X);
  grid.half_height = points(options.half_height, grid.pitch_Y);
  return grid;
}

} // namespace

NearTipField::NearTipField(const NearTipGrid &grid_of_points) : grid(grid_of_points), occupancy(grid.size(), 0.)
{
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (auto *vectors : {&velocity, &displacement, &excess_displacement})
    vectors->assign(grid.size(), Eigen::Vector2d::Constant(none));
  for (lattice::TensorField *tensors :
       {&deformation_gradient, &first_piola_stress, &cauchy_stress, &strain_gradient_x, &strain_gradient_y})
    tensors->assign(grid.size(), Eigen::Matrix2d::Constant(none));
}

template <int n>
void NearTipSums::Sum<n>::make_room(const NearTipGrid &grid)
{
  if (weights.size() > 0)
    return;
  values.setZero(n, static_cast<Eigen::Index>(grid.size()));
  weights.setZero(static_cast<Eigen::Index>(grid.size()));
}

template <int n>
void NearTipSums::Sum<n>::add(std::size_t point, double weight, const Values &site)
{
  const auto p = static_cast<Eigen::Index>(point);
  values.col(p) += weight * site;
  weights[p] += weight;
}

template <int n>
void NearTipSums::Sum<n>::add(const Sum &other, const NearTipGrid &grid, const Values *signs)
{
  if (other.weights.size() == 0)
    return;
  make_room(grid);
  if (signs == nullptr)
  {
    values += other.values;
    weights += other.weights;
    return;
  }
  for (int j = -grid.half_height; j <= grid.half_height; ++j)
    for (int i = -grid.behind; i <= grid.ahead; ++i)
    {
      const auto to = static_cast<Eigen::Index>(grid.point(i, j));
      const auto from = static_cast<Eigen::Index>(grid.point(i, -j));
      values.col(to) += *signs * other.values.col(from);
      weights[to] += other.weights[from];
    }
}

template <int n>
auto NearTipSums::Sum<n>::mean(std::size_t point) const -> std::optional<Values>
{
  const auto p = static_cast<Eigen::Index>(point);
  if (weights.size() == 0 || !(weights[p] > 0.))
    return std::nullopt;
  return Values(values.col(p) / weights[p]);
}

NearTipSums::NearTipSums(const NearTipGrid &grid) : grid_(grid) {}

void NearTipSums::add_site(int i2, int j2, const Motion &motion, const std::optional<Tensors> &tensors,
                           const std::optional<Gradients> &gradients)
{
  motion_.make_room(grid_);
  if (tensors)
    tensors_.make_room(grid_);
  if (gradients)
    gradients_.make_room(grid_);
  // An odd number is half-way between two points; no site is half-way in both directions.
  const auto low = [](int twice) { return twice >= 0 ? twice / 2 : -((1 - twice) / 2); };
  const int i_low = low(i2), i_high = low(i2 + 1), j_low = low(j2), j_high = low(j2 + 1);
  const double weight = (i_low == i_high ? 1. : 0.5) * (j_low == j_high ? 1. : 0.5);
  for (int j = j_low; j <= j_high; ++j)
    for (int i = i_low; i <= i_high; ++i)
    {
      if (!grid_.contains(i, j))
        continue;
      const std::size_t point = grid_.point(i, j);
      motion_.add(point, weight, motion);
      if (tensors)
        tensors_.add(point, weight, *tensors);
      if (gradients)
        gradients_.add(point, weight, *gradients);
    }
}

void NearTipSums::add(const NearTipSums &other, bool mirrored)
{
  samples_ += other.samples_;
  motion_.add(other.motion_, grid_, mirrored ? &mirror_signs().motion : nullptr);
  tensors_.add(other.tensors_, grid_, mirrored ? &mirror_signs().tensors : nullptr);
  gradients_.add(other.gradients_, grid_, mirrored ? &mirror_signs().gradients : nullptr);
}

NearTipField NearTipSums::mean() const
{
  NearTipField field(grid_);
  field.samples = samples_;
  for (std::size_t point = 0; point < grid_.size(); ++point)
  {
    if (const std::optional<Motion> mean = motion_.mean(point))
    {
      field.occupancy[point] = motion_.weights[static_cast<Eigen::Index>(point)] / static_cast<double>(samples_);
      field.velocity[point] = vector_in(*mean, 0);
      field.displacement[point] = vector_in(*mean, 2);
      field.excess_displacement[point] = vector_in(*mean, 4);
    }
    if (const std::optional<Tensors> mean = tensors_.mean(point))
    {
      field.deformation_gradient[point] = tensor_in(*mean, 0);
      field.first_piola_stress[point] = tensor_in(*mean, 4);
      field.cauchy_stress[point] = tensor_in(*mean, 8);
    }
    if (const std::optional<Gradients> mean = gradients_.mean(point))
    {
      field.strain_gradient_x[point] = symmetric_in(*mean, 0);
      field.strain_gradient_y[point] = symmetric_in(*mean, 3);
    }
  }
  return field;
}

NearTipSampler::NearTipSampler(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                               const NearTipOptions &options)
  : lattice_(lattice), material_(material), options_(options), grid_(make_grid(lattice, options)),
    evaluator_(lattice, material), gradient_fit_(lattice), plain_(grid_), folded_(n_blocks, NearTipSums(grid_))
{
  if (!(options.X_end >= options.X_begin))
    throw std::invalid_argument("the sampled interval of the tip must have X_end > X_begin");
}

bool NearTipSampler::samples_at(std::size_t tip) const
{
  const double X = lattice_.reference(tip).x();
  return X >= options_.X_begin && X <= options_.X_end;
}

// Returns those of `n` rows or columns that a grid around the tip may need.
lattice::Rows NearTipSampler::around(std::size_t centre, int before, int after, std::size_t n) const
{
  // One beyond the grid, up to four between the tip and the axis, and those of bonds that reach a site.
  const int more = 5 + static_cast<int>(lattice_.reach());
  const auto first = static_cast<std::ptrdiff_t>(centre) - before - more;
  return {static_cast<std::size_t>(std::max<std::ptrdiff_t>(first, 0)),
          std::min(n, centre + static_cast<std::size_t>(after + more + 1))};
}

lattice::Rows NearTipSampler::rows_around(std::size_t tip) const
{
  const bool along = lattice_.orientation() == lattice::Orientation::rows_along_crack;
  return around(lattice_.row_of(tip), along ? grid_.half_height : grid_.behind, along ? grid_.half_height : grid_.ahead,
                lattice_.rows());
}

lattice::Rows NearTipSampler::columns_around(std::size_t tip) const
{
  const bool along = lattice_.orientation() == lattice::Orientation::rows_along_crack;
  return around(lattice_.column_of(tip), along ? grid_.behind : grid_.half_height,
                along ? grid_.ahead : grid_.half_height, lattice_.columns());
}

const NearTipSample *NearTipSampler::sample(const lattice::State &state, std::size_t tip)
{
  calls_at_rest_ = last_tip_ == tip ? calls_at_rest_ + 1 : 0;
  last_tip_ = tip;
  const Axis now = axis(state, tip);
  path_.push_back(now.reference);
  fold_until(now.reference.x() - heading_to * lattice_.lattice_spacing());
  if (!samples_at(tip) || calls_at_rest_ >= calls_of_rest)
    return nullptr;
  pending_.push_back(look(state, now, tip, taken_ % samples_for_tensors == 0));
  ++taken_;
  plain_.add(pending_.back().sums, false);
  return &pending_.back();
}

NearTipSampler::Axis NearTipSampler::axis(const lattice::State &state, std::size_t tip) const
{
  // Sites at the X of the tip are a row of the same shift apart, or neighbours in the row across.
  const bool along = lattice_.orientation() == lattice::Orientation::rows_along_crack;
  const std::size_t rows = lattice_.grid().kind == lattice::Grid::Kind::triangular ? 2 : 1;
  const auto step = static_cast<std::ptrdiff_t>(along ? rows * lattice_.stride() : 1);
  std::size_t lowest = tip, highest = tip;
  for (std::ptrdiff_t n = -2; n <= 2; ++n)
  {
    const auto place = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(tip) + n * step);
    if (place >= lattice_.n_places() || !lattice_.is_site(place) || state.removed[place] != 0 ||
        state.lost_bonds[place] != state.lost_bonds[tip])
      continue;
    lowest = std::min(lowest, place);
    highest = std::max(highest, place);
  }
  const Eigen::Vector2d low(state.x[lowest], state.y[lowest]), high(state.x[highest], state.y[highest]);
  return {0.5 * (lattice_.reference(lowest) + lattice_.reference(highest)), 0.5 * (low + high)};
}

NearTipSample NearTipSampler::look(const lattice::State &state, const Axis &axis, std::size_t tip, bool with_tensors)
{
  const double part = (axis.reference.x() - options_.X_begin) / (options_.X_end - options_.X_begin);
  NearTipSample sample{axis.reference.x(),
                       axis.reference.y(),
                       part > 0. ? static_cast<std::size_t>(std::min(part * n_blocks, n_blocks - 1.)) : 0,
                       NearTipSums(grid_),
                       {}};
  sample.sums.add_sample();
  const auto look_at = [&](std::size_t place)
  {
    const Eigen::Vector2d reference = lattice_.reference(place), offset = reference - axis.reference;
    // Half a pitch beyond the grid: sites there count half at the rim.
    if (offset.x() < -(grid_.behind + 0.75) * grid_.pitch_X || offset.x() > (grid_.ahead + 0.75) * grid_.pitch_X ||
        std::abs(offset.y()) > (grid_.half_height + 0.75) * grid_.pitch_Y)
      return;
    if (state.removed[place] != 0 || 2u * state.lost_bonds[place] > material_.coordination(lattice_, place))
      return;
    const Eigen::Vector2d position(state.x[place], state.y[place]);
    const Eigen::Vector2d displacement = position - axis.current - offset;
    const Eigen::Vector2d from_loading = position - options_.deformation * reference;
    NearTipSums::Motion motion;
    motion << state.vx[place], state.vy[place], displacement.x(), displacement.y(), from_loading.x(), from_loading.y();
    std::optional<NearTipSums::Tensors> tensors;
    std::optional<NearTipSums::Gradients> gradients;
    if (with_tensors)
    {
      const lattice::SiteValues site = evaluator_.at(state, place);
      const Eigen::Matrix2d &F = site.deformation_gradient, &P = site.first_piola_stress, &sigma = site.cauchy_stress;
      tensors.emplace();
      *tensors << F(0, 0), F(0, 1), F(1, 0), F(1, 1), P(0, 0), P(0, 1), P(1, 0), P(1, 1), sigma(0, 0), sigma(0, 1),
        sigma(1, 0), sigma(1, 1);
      if (const std::optional<lattice::StrainGradient> G = gradient_fit_.at(state, place))
      {
        gradients.emplace();
        *gradients << G->x(0, 0), G->x(0, 1), G->x(1, 1), G->y(0, 0), G->y(0, 1), G->y(1, 1);
      }
    }
    const auto twice = [](double length, double pitch) { return static_cast<int>(std::lround(2. * length / pitch)); };
    sample.sums.add_site(twice(offset.x(), grid_.pitch_X), twice(offset.y(), grid_.pitch_Y), motion, tensors,
                         gradients);
    sample.sites.emplace_back(position - axis.current);
  };
  const lattice::Rows rows = rows_around(tip), columns = columns_around(tip);
  for (std::size_t row = rows.begin; row < rows.end; ++row)
    for (std::size_t column = columns.begin; column < std::min(columns.end, lattice_.sites_in_row(row)); ++column)
      look_at(lattice_.index(row, column));
  return sample;
}

bool NearTipSampler::descends(double X) const
{
  double before = 0., after = 0.;
  int n_before = 0, n_after = 0;
  const double from = heading_from * lattice_.lattice_spacing(), to = heading_to * lattice_.lattice_spacing();
  for (auto point = path_.rbegin(); point != path_.rend() && point->x() >= X - to; ++point)
  {
    const double distance = point->x() - X;
    if (distance <= -from)
    {
      before += point->y();
      ++n_before;
    }
    else if (distance >= from && distance <= to)
    {
      after += point->y();
      ++n_after;
    }
  }
  return n_before > 0 && n_after > 0 && after / n_after < before / n_before;
}

void NearTipSampler::fold_until(double X)
{
  while (!pending_.empty() && pending_.front().X <= X)
  {
    const NearTipSample &sample = pending_.front();
    folded_[sample.block].add(sample.sums, descends(sample.X));
    pending_.pop_front();
  }
}

void NearTipSampler::finish()
{
  fold_until(std::numeric_limits<double>::infinity());
}

NearTipField NearTipSampler::folded() const
{
  NearTipSums all(grid_);
  for (const NearTipSums &block : folded_)
    all.add(block, false);
  return all.mean();
}

} // namespace latcon::analysis
