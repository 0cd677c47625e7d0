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
NearTipSums::Values mirror_signs(NearTipSums::Part part)
{
  NearTipSums::Values signs(NearTipSums::n_components[part]);
  if (part == NearTipSums::tensors)
    signs << 1, -1, -1, 1, 1, -1, -1, 1, 1, -1, -1, 1;
  else
    signs << 1, -1, 1, -1, 1, -1; // of vectors; xXX, xXY, xYY, yXX, yXY, yYY
  return signs;
}

using RowMajor = Eigen::Matrix<double, 2, 2, Eigen::RowMajor>;

NearTipGrid make_grid(const lattice::TriangularLattice &lattice, const NearTipOptions &options)
{
  const double d = lattice.spacing(), across = lattice.site_area() / d;
  NearTipGrid grid;
  const bool along = lattice.orientation() == lattice::Orientation::rows_along_crack;
  grid.pitch_X = along ? d : across;
  grid.pitch_Y = along ? across : d;
  grid.spacing = lattice.lattice_spacing();
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
  for (std::vector<Eigen::Matrix2d> *tensors :
       {&deformation_gradient, &first_piola_stress, &cauchy_stress, &strain_gradient_x, &strain_gradient_y})
    tensors->assign(grid.size(), Eigen::Matrix2d::Constant(none));
}

void NearTipSums::make_room(Part part)
{
  if (sums_[part].weights.size() > 0)
    return;
  sums_[part].values.setZero(n_components[part], static_cast<Eigen::Index>(grid_.size()));
  sums_[part].weights.setZero(static_cast<Eigen::Index>(grid_.size()));
}

void NearTipSums::add_site(int i2, int j2, const Site &site)
{
  // An odd number is half-way between two points; no site is half-way in both directions.
  const auto low = [](int twice) { return twice >= 0 ? twice / 2 : -((1 - twice) / 2); };
  const int i_low = low(i2), i_high = low(i2 + 1), j_low = low(j2), j_high = low(j2 + 1);
  const double weight = (i_low == i_high ? 1. : 0.5) * (j_low == j_high ? 1. : 0.5);
  for (const Part part : {motion, tensors, gradients})
  {
    if (site[part].size() == 0)
      continue;
    make_room(part);
    for (int j = j_low; j <= j_high; ++j)
      for (int i = i_low; i <= i_high; ++i)
        if (grid_.contains(i, j))
        {
          const auto point = static_cast<Eigen::Index>(grid_.point(i, j));
          sums_[part].values.col(point) += weight * site[part];
          sums_[part].weights[point] += weight;
        }
  }
}

void NearTipSums::add(const NearTipSums &other, bool mirrored)
{
  samples_ += other.samples_;
  for (const Part part : {motion, tensors, gradients})
  {
    const Sum &from = other.sums_[part];
    if (from.weights.size() == 0)
      continue;
    make_room(part);
    const Values signs = mirrored ? mirror_signs(part) : Values::Ones(n_components[part]);
    const Eigen::Index columns = grid_.columns(), rows = grid_.rows(); // of points, see NearTipGrid::point
    for (Eigen::Index row = 0; row < rows; ++row)
    {
      const Eigen::Index to = row * columns, image = (mirrored ? rows - 1 - row : row) * columns;
      sums_[part].values.middleCols(to, columns) += from.values.middleCols(image, columns).colwise() * signs;
      sums_[part].weights.segment(to, columns) += from.weights.segment(image, columns);
    }
  }
}

NearTipField NearTipSums::mean() const
{
  NearTipField field(grid_);
  field.samples = samples_;
  for (std::size_t point = 0; point < grid_.size(); ++point)
  {
    const auto p = static_cast<Eigen::Index>(point);
    const auto mean = [&](Part part) -> Values
    {
      const Sum &sum = sums_[part];
      if (sum.weights.size() > 0 && sum.weights[p] > 0.)
        return sum.values.col(p) / sum.weights[p];
      return Values::Constant(n_components[part], std::numeric_limits<double>::quiet_NaN());
    };
    const Values of_motion = mean(motion), of_tensors = mean(tensors), G = mean(gradients);
    field.occupancy[point] =
      sums_[motion].weights.size() > 0 ? sums_[motion].weights[p] / static_cast<double>(samples_) : 0.;
    field.velocity[point] = of_motion.segment<2>(0);
    field.displacement[point] = of_motion.segment<2>(2);
    field.excess_displacement[point] = of_motion.segment<2>(4);
    field.deformation_gradient[point] = Eigen::Map<const RowMajor>(of_tensors.data());
    field.first_piola_stress[point] = Eigen::Map<const RowMajor>(of_tensors.data() + 4);
    field.cauchy_stress[point] = Eigen::Map<const RowMajor>(of_tensors.data() + 8);
    field.strain_gradient_x[point] << G[0], G[1], G[1], G[2];
    field.strain_gradient_y[point] << G[3], G[4], G[4], G[5];
  }
  return field;
}

NearTipSampler::NearTipSampler(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                               const NearTipOptions &options)
  : lattice_(lattice), material_(material), options_(options), grid_(make_grid(lattice, options)),
    gradient_fits_(2, lattice::StrainGradientFit(lattice)), plain_(grid_), folded_(n_blocks, NearTipSums(grid_))
{
  if (!(options.X_end >= options.X_begin))
    throw std::invalid_argument("the sampled interval of the tip must have X_end > X_begin");
}

bool NearTipSampler::samples_at(std::size_t tip) const
{
  const double X = lattice_.reference(tip).x();
  return X >= options_.X_begin && X <= options_.X_end;
}

// Returns the rows, or the columns, that a grid around the tip may need.
lattice::Rows NearTipSampler::around(std::size_t tip, bool rows) const
{
  // One beyond the grid, up to four between the tip and the axis, and those of bonds that reach a site.
  const int more = 5 + static_cast<int>(lattice_.reach());
  const bool is_across = rows == (lattice_.orientation() == lattice::Orientation::rows_along_crack);
  const int before = is_across ? grid_.half_height : grid_.behind, after = is_across ? grid_.half_height : grid_.ahead;
  const std::size_t centre = rows ? lattice_.row_of(tip) : lattice_.column_of(tip);
  const auto first = static_cast<std::ptrdiff_t>(centre) - before - more;
  return {static_cast<std::size_t>(std::max<std::ptrdiff_t>(first, 0)),
          std::min(rows ? lattice_.rows() : lattice_.columns(), centre + static_cast<std::size_t>(after + more + 1))};
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
  pending_.push_back(look(state, now, tip, samples() % samples_for_tensors == 0));
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
  const Eigen::Vector2d low = state.position.at(lowest), high(state.position.x[highest], state.position.y[highest]);
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
  const auto look_at = [&](std::size_t place, NearTipSample &half, lattice::StrainGradientFit &gradient_fit)
  {
    const Eigen::Vector2d reference = lattice_.reference(place), offset = reference - axis.reference;
    // Half a pitch beyond the grid: sites there count half at the rim.
    if (offset.x() < -(grid_.behind + 0.75) * grid_.pitch_X || offset.x() > (grid_.ahead + 0.75) * grid_.pitch_X ||
        std::abs(offset.y()) > (grid_.half_height + 0.75) * grid_.pitch_Y)
      return;
    if (state.removed[place] != 0 || 2u * state.lost_bonds[place] > material_.coordination(lattice_, place))
      return;
    const Eigen::Vector2d position = state.position.at(place);
    const Eigen::Vector2d displacement = position - axis.current - offset;
    const Eigen::Vector2d from_loading = position - options_.deformation * reference;
    NearTipSums::Site values;
    values[NearTipSums::motion].resize(6);
    values[NearTipSums::motion] << state.velocity.x[place], state.velocity.y[place], displacement, from_loading;
    if (with_tensors)
    {
      const lattice::SiteValues site = site_values(state, lattice_, material_, place);
      values[NearTipSums::tensors].resize(12);
      values[NearTipSums::tensors] << site.deformation_gradient.reshaped<Eigen::RowMajor>(),
        site.first_piola_stress.reshaped<Eigen::RowMajor>(), site.cauchy_stress.reshaped<Eigen::RowMajor>();
      if (const std::optional<lattice::StrainGradient> G = gradient_fit.at(state, place))
      {
        values[NearTipSums::gradients].resize(6);
        values[NearTipSums::gradients] << G->x(0, 0), G->x(0, 1), G->x(1, 1), G->y(0, 0), G->y(0, 1), G->y(1, 1);
      }
    }
    const auto twice = [](double length, double pitch) { return static_cast<int>(std::lround(2. * length / pitch)); };
    half.sums.add_site(twice(offset.x(), grid_.pitch_X), twice(offset.y(), grid_.pitch_Y), values);
    half.sites.emplace_back(position - axis.current);
  };
  // Always two halves: sums have the same bits for any number of threads.
  const auto [begin, end] = rows_around(tip);
  const std::array<std::size_t, 3> bounds{begin, begin + (end - begin) / 2, end};
  NearTipSample upper = sample;
#pragma omp parallel for
  for (std::size_t half = 0; half < 2; ++half)
    for (const std::size_t place : lattice_.sites({bounds[half], bounds[half + 1]}, around(tip, false)))
      look_at(place, half == 0 ? sample : upper, gradient_fits_[half]);
  sample.sums.add(upper.sums, false);
  sample.sites.insert(sample.sites.end(), upper.sites.begin(), upper.sites.end());
  sample.sums.add_sample();
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
