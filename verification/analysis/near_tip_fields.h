#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include "lattice/site_fields.h"
#include "support/require.h"

namespace latcon::analysis
{

/// Regular grid in the reference configuration that moves with the tip: points at (X, Y) - (X_tip, Y_tip), one of them
/// at the tip. Its pitch is that of the lattice, d along the rows and (sqrt3 / 2) d across them, so that each point
/// represents the area of one site.
struct NearTipGrid
{
  double pitch_X = 0., pitch_Y = 0.; ///< [m]
  double spacing = 0.;               ///< d of the lattice [m]
  int behind = 0;                    ///< points behind the tip
  int ahead = 0;                     ///< points ahead of it
  int half_height = 0;               ///< points on either side of it

  int columns() const { return behind + 1 + ahead; }
  int rows() const { return 2 * half_height + 1; }
  std::size_t size() const { return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()); }
  /// Returns the index of the point i pitches ahead of the tip and j above it; -behind <= i <= ahead, |j| <=
  /// half_height. Points are ordered by rows of constant Y from the bottom, as in vtkImageData.
  std::size_t point(int i, int j) const
  {
    return static_cast<std::size_t>(j + half_height) * static_cast<std::size_t>(columns()) +
           static_cast<std::size_t>(i + behind);
  }
  bool contains(int i, int j) const { return i >= -behind && i <= ahead && j >= -half_height && j <= half_height; }
  /// Returns (X, Y) - (X_tip, Y_tip) of a point [m].
  Eigen::Vector2d reference(int i, int j) const { return {i * pitch_X, j * pitch_Y}; }
};

/// Means over samples at the points of a grid. A site between two points counts half at each. Values are NaN at points
/// without a site in any sample.
struct NearTipField
{
  NearTipGrid grid;
  std::size_t samples = 0;
  /// Fraction of samples with a site that has at least half its bonds [-], 0 to 1.
  std::vector<double> occupancy;
  std::vector<Eigen::Vector2d> velocity; ///< in the laboratory frame [m/s]
  /// (x - x_tip) - (X - X_tip) [m]: displacement of the grid to the current configuration, with the tip at the origin.
  std::vector<Eigen::Vector2d> displacement;
  std::vector<Eigen::Vector2d> excess_displacement; ///< x - F X [m], with F of the loaded sheet
  // Means over every fourth sample, starting with the first: these fields are expensive and change slowly.
  std::vector<Eigen::Matrix2d> deformation_gradient; ///< see SiteValues
  std::vector<Eigen::Matrix2d> first_piola_stress;   ///< [Pa], see SiteValues
  std::vector<Eigen::Matrix2d> cauchy_stress;        ///< [Pa], see SiteValues
  std::vector<Eigen::Matrix2d> strain_gradient_x,
    strain_gradient_y; ///< [1/m], see StrainGradient; where the bonds determine it

  explicit NearTipField(const NearTipGrid &grid);
  /// Returns true if at least half of the samples have material at a point of the grid.
  bool holds(int i, int j) const { return grid.contains(i, j) && occupancy[grid.point(i, j)] >= 0.5; }
  /// Returns the current position of a point relative to the tip [m].
  Eigen::Vector2d position(int i, int j) const { return grid.reference(i, j) + displacement[grid.point(i, j)]; }
};

/// Sums over samples. Sums can be added to each other, directly or mirrored in Y.
class NearTipSums
{
public:
  explicit NearTipSums(const NearTipGrid &grid) : grid_(grid) {}

  /// Parts of the values of a site, with components in the order of NearTipField.
  enum Part
  {
    motion,    ///< velocity and both displacements
    tensors,   ///< deformation gradient and both stresses
    gradients, ///< of strain
    n_parts
  };
  static constexpr Eigen::Index n_components[n_parts] = {6, 12, 6};
  using Values = Eigen::Array<double, Eigen::Dynamic, 1, 0, 12, 1>;
  using Site = std::array<Values, n_parts>; ///< empty: no values of this part

  /// Adds a site at (i2, j2), twice its position in pitches. Sites beyond the grid are ignored.
  void add_site(int i2, int j2, const Site &site);
  void add_sample() { ++samples_; }
  void add(const NearTipSums &other, bool mirrored);
  std::size_t samples() const { return samples_; }
  NearTipField mean() const;

  /// Saves or loads the sums over the same grid; see Simulation. @throws std::invalid_argument if the grid differs
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("samples", samples_);
    archive("motion", sums_[motion]);
    archive("gradients", sums_[gradients]);
    archive("tensors", sums_[tensors]);
    if constexpr (Archive::loads)
      for (std::size_t part = 0; part < n_parts; ++part)
      {
        const Sum &sum = sums_[part];
        support::require(sum.values.cols() == 0 || sum.values.rows() == n_components[part],
                         "the numbers of near-tip `values` and `weights` do not match");
        support::require(sum.values.cols() == 0 || static_cast<std::size_t>(sum.values.cols()) == grid_.size(),
                         "the near-tip sums belong to another grid");
      }
  }

private:
  /// Weighted sums at the points, in columns. Allocated when the first site is added.
  struct Sum
  {
    Eigen::ArrayXXd values;
    Eigen::ArrayXd weights;

    template <class Archive>
    void archive(Archive &archive)
    {
      std::vector<double> all(values.data(), values.data() + values.size());
      std::vector<double> of_points(weights.data(), weights.data() + weights.size());
      archive("values", all);
      archive("weights", of_points);
      const auto points = static_cast<Eigen::Index>(of_points.size());
      const Eigen::Index components = points > 0 ? static_cast<Eigen::Index>(all.size()) / points : 0;
      support::require(all.size() == static_cast<std::size_t>(components * points),
                       "the numbers of near-tip `values` and `weights` do not match");
      values = Eigen::Map<const Eigen::ArrayXXd>(all.data(), components, points);
      weights = Eigen::Map<const Eigen::ArrayXd>(of_points.data(), points);
    }
  };
  void make_room(Part part);

  NearTipGrid grid_;
  std::size_t samples_ = 0;
  std::array<Sum, n_parts> sums_;
};

/// Sample of the neighbourhood of the tip.
struct NearTipSample
{
  double X, Y;       ///< of the tip (Y of the axis of symmetry), reference [m]
  std::size_t block; ///< quarter of the sampled interval of X, 0 to 3
  NearTipSums sums;
  std::vector<Eigen::Vector2d>
    sites; ///< current positions relative to the tip [m] of sites with at least half their bonds

  template <class Archive>
  void archive(Archive &archive)
  {
    archive("X", X);
    archive("Y", Y);
    archive("block", block);
    archive("sums", sums);
    archive("sites", sites);
  }
};

/// Options of NearTipSampler.
struct NearTipOptions
{
  double behind = 0., ahead = 0., half_height = 0.; ///< extent of the grid [m], > 0
  double X_begin = 0., X_end = 0.;                  ///< interval of the tip in which samples are taken, reference [m]
  Eigen::Matrix2d deformation = Eigen::Matrix2d::Identity(); ///< F of the loaded sheet
};

/// Averages the fields around a running tip (theory.md, section "Near the tip").
///
/// There are two averages. The plain average is over all samples. For the folded average, samples on descending parts
/// of the path are first mirrored in Y, so that features on one side of an oscillating path stay on one side. The path
/// descends if its mean Y between 2.5 and 7.5 d ahead of the tip of the sample is below that between 2.5 and 7.5 d
/// behind it.
///
/// If several sites at the same X have lost the same number of bonds, the tip is their mean, so that the axis of a
/// symmetric state is that of the grid.
class NearTipSampler
{
public:
  static constexpr std::size_t n_blocks = 4;

  /// The lattice must outlive this object.
  NearTipSampler(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                 const NearTipOptions &options);

  /// Takes a sample. To be called at equal time intervals, for every position of the tip. @param tip slot of the tip
  /// @return the sample, valid until the next call; null if no sample is taken, because the tip is not between X_begin
  /// and X_end or has rested during the last ten calls
  const NearTipSample *sample(const lattice::State &state, std::size_t tip);

  /// Returns true if sample() takes a sample at this position of the tip, unless the tip rests.
  bool samples_at(std::size_t tip) const;
  /// Returns the rows that sample() needs at this position of the tip.
  lattice::Rows rows_around(std::size_t tip) const { return around(tip, true); }

  /// Folds the remaining samples with the known part of the path. To be called once, after the last sample.
  void finish();

  std::size_t samples() const { return plain_.samples(); }
  const NearTipGrid &grid() const { return grid_; }
  /// Returns the mean over all samples.
  NearTipField plain() const { return plain_.mean(); }
  /// Returns the mean over all samples folded so far.
  NearTipField folded() const;
  /// Returns the folded sums of one block.
  const NearTipSums &folded_block(std::size_t block) const { return folded_[block]; }

  /// Saves or loads the sums and the pending samples; see Simulation. @throws std::invalid_argument for data that do
  /// not belong to this sheet
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("path", path_);
    archive("plain", plain_);
    archive("folded", folded_);
    std::size_t n_pending = pending_.size();
    archive("n_pending", n_pending);
    if constexpr (Archive::loads)
    {
      support::require(folded_.size() == n_blocks && n_pending <= path_.size(),
                       "`n_pending` exceeds the number of samples");
      pending_.assign(n_pending, {0., 0., 0, NearTipSums(grid_), {}});
    }
    archive("pending", pending_);
    archive("last_tip", last_tip_);
    archive("calls_at_rest", calls_at_rest_);
    if constexpr (Archive::loads)
    {
      support::require(samples() <= path_.size() && n_pending <= samples(),
                       "`samples` does not match the length of `path`");
      support::require(!last_tip_ || (*last_tip_ < lattice_.n_places() && lattice_.is_site(*last_tip_)),
                       "`last_tip` is not a site of the sheet");
      std::size_t folded = 0;
      for (const NearTipSums &sums : folded_)
        folded += sums.samples();
      support::require(folded == samples() - n_pending, "`samples` does not match the number of samples taken");
      for (const NearTipSample &sample : pending_)
        support::require(sample.block < n_blocks && sample.sums.samples() == 1, "a pending sample is invalid");
    }
  }

private:
  struct Axis
  {
    Eigen::Vector2d reference, current; // of the tip [m]
  };
  Axis axis(const lattice::State &state, std::size_t tip) const;
  lattice::Rows around(std::size_t tip, bool rows) const;
  NearTipSample look(const lattice::State &state, const Axis &axis, std::size_t tip, bool with_tensors);
  bool descends(double X) const;
  void fold_until(double X);

  const lattice::TriangularLattice &lattice_;
  lattice::Material material_;
  NearTipOptions options_;
  NearTipGrid grid_;
  std::vector<lattice::StrainGradientFit> gradient_fits_; // one for each half of a window
  std::vector<Eigen::Vector2d> path_;                     // of the tip at all calls, reference [m]
  NearTipSums plain_;
  std::vector<NearTipSums> folded_;   // sums per block
  std::deque<NearTipSample> pending_; // not folded yet
  std::optional<std::size_t> last_tip_;
  std::size_t calls_at_rest_ = 0;
};

} // namespace latcon::analysis
