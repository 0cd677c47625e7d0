#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "lattice/archive_rows.h"
#include "lattice/site_fields.h"
#include "lattice/strain_gradient.h"

namespace latcon::analysis
{

/// A regular grid in the reference configuration that moves with the tip: points at (X, Y) - (X_tip, Y_tip), the tip
/// among them. Its pitch is that of the lattice, d along the rows and (sqrt3 / 2) d across them, so that each point
/// stands for the area of one site.
struct NearTipGrid
{
  double pitch_X = 0., pitch_Y = 0.; ///< [m]
  int behind = 0;                    ///< points behind the tip
  int ahead = 0;                     ///< points ahead of it
  int half_height = 0;               ///< points on either side of it

  int columns() const { return behind + 1 + ahead; }
  int rows() const { return 2 * half_height + 1; }
  std::size_t size() const { return static_cast<std::size_t>(columns()) * static_cast<std::size_t>(rows()); }
  /// Number of the point i pitches ahead of the tip and j above it; -behind <= i <= ahead, |j| <= half_height. Rows of
  /// constant Y follow each other from below, as in vtkImageData.
  std::size_t point(int i, int j) const
  {
    return static_cast<std::size_t>(j + half_height) * static_cast<std::size_t>(columns()) +
           static_cast<std::size_t>(i + behind);
  }
  bool contains(int i, int j) const { return i >= -behind && i <= ahead && j >= -half_height && j <= half_height; }
  /// (X, Y) - (X_tip, Y_tip) of a point [m].
  Eigen::Vector2d reference(int i, int j) const { return {i * pitch_X, j * pitch_Y}; }
};

/// Means over samples at the points of a grid. A site between two points counts half at each. Values are not-a-number
/// where no sample had a site.
struct NearTipField
{
  NearTipGrid grid;
  std::size_t samples = 0;
  /// Fraction of samples in which there was a site with at least half its bonds [-], 0 to 1.
  std::vector<double> occupancy;
  std::vector<Eigen::Vector2d> velocity; ///< of the laboratory [m/s]
  /// (x - x_tip) - (X - X_tip) [m]: what moves the grid into the current configuration, the tip at the origin.
  std::vector<Eigen::Vector2d> displacement;
  std::vector<Eigen::Vector2d> excess_displacement; ///< x - F X [m], F that of the loaded sheet
  // Over every fourth sample, from the first on: they cost more than the rest and change as slowly.
  lattice::TensorField deformation_gradient;                 ///< see SiteValues
  lattice::TensorField first_piola_stress;                   ///< [Pa], likewise
  lattice::TensorField cauchy_stress;                        ///< [Pa], likewise
  lattice::TensorField strain_gradient_x, strain_gradient_y; ///< [1/m], see StrainGradient; where its bonds fix it

  explicit NearTipField(const NearTipGrid &grid);
  /// Whether material was at a point of the grid more often than not: what lies off the crack.
  bool holds(int i, int j) const { return grid.contains(i, j) && occupancy[grid.point(i, j)] >= 0.5; }
  /// Current position of a point relative to the tip [m].
  Eigen::Vector2d position(int i, int j) const { return grid.reference(i, j) + displacement[grid.point(i, j)]; }
};

/// Sums over samples, which may be added to each other, as they are or mirrored in Y.
class NearTipSums
{
public:
  explicit NearTipSums(const NearTipGrid &grid);

  // Components in the order of NearTipField.
  using Motion = Eigen::Array<double, 6, 1>;    ///< velocity and both displacements
  using Tensors = Eigen::Array<double, 12, 1>;  ///< deformation gradient and both stresses
  using Gradients = Eigen::Array<double, 6, 1>; ///< of strain

  /// Adds a site at twice its place in pitches, (i2, j2); what falls beyond the grid is dropped.
  void add_site(int i2, int j2, const Motion &motion, const std::optional<Tensors> &tensors,
                const std::optional<Gradients> &gradients);
  void add_sample() { ++samples_; }
  void add(const NearTipSums &other, bool mirrored);
  std::size_t samples() const { return samples_; }
  NearTipField mean() const;

  /// Saves or loads the sums, over the same grid; see Simulation. @throws std::invalid_argument if it is another
  template <class Archive>
  void archive(Archive &archive)
  {
    archive("samples", samples_);
    archive("motion", motion_);
    archive("gradients", gradients_);
    archive("tensors", tensors_);
    if constexpr (Archive::loads)
      lattice::require_archived(motion_.fits(grid_) && gradients_.fits(grid_) && tensors_.fits(grid_),
                                "sums near the tip are over another grid");
  }

private:
  /// Weighted sums of n components at the points. Takes no memory, and no time, before the first site.
  template <int n>
  struct Sum
  {
    using Values = Eigen::Array<double, n, 1>;
    Eigen::Array<double, n, Eigen::Dynamic> values;
    Eigen::ArrayXd weights;

    void make_room(const NearTipGrid &grid);
    void add(std::size_t point, double weight, const Values &site);
    /// @param signs of the components in a mirror image in Y; null: `other` is added as it is
    void add(const Sum &other, const NearTipGrid &grid, const Values *signs);
    std::optional<Values> mean(std::size_t point) const;
    /// Whether it has values at all points, or at none.
    bool fits(const NearTipGrid &grid) const
    {
      return weights.size() == values.cols() &&
             (weights.size() == 0 || static_cast<std::size_t>(weights.size()) == grid.size());
    }

    template <class Archive>
    void archive(Archive &archive)
    {
      std::vector<double> all(values.data(), values.data() + values.size());
      std::vector<double> of_points(weights.data(), weights.data() + weights.size());
      archive("values", all);
      archive("weights", of_points);
      lattice::require_archived(all.size() == n * of_points.size(),
                                "`values` near the tip are not as many as `weights`");
      values = Eigen::Map<const decltype(values)>(all.data(), n, static_cast<Eigen::Index>(all.size()) / n);
      weights = Eigen::Map<const Eigen::ArrayXd>(of_points.data(), static_cast<Eigen::Index>(of_points.size()));
    }
  };

  NearTipGrid grid_;
  std::size_t samples_ = 0;
  Sum<6> motion_, gradients_;
  Sum<12> tensors_;
};

/// One look at the neighbourhood of the tip.
struct NearTipSample
{
  double X, Y;       ///< of the tip, Y that of the axis of symmetry, reference [m]
  std::size_t block; ///< quarter of the stretch in which samples are taken, 0 to 3
  NearTipSums sums;
  std::vector<Eigen::Vector2d>
    sites; ///< current positions relative to the tip [m], sites with at least half their bonds

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

/// Where and of what samples are taken.
struct NearTipOptions
{
  double behind = 0., ahead = 0., half_height = 0.; ///< extent of the grid [m], > 0
  double X_begin = 0., X_end = 0.;                  ///< samples are taken while the tip is between these, reference [m]
  Eigen::Matrix2d deformation = Eigen::Matrix2d::Identity(); ///< F of the loaded sheet
};

/// Averages the fields around a running tip (theory.md, section "Near the tip").
///
/// There are two averages: the plain one, and a folded one, in which samples from where the path descends are mirrored
/// in Y first, so that what an oscillating crack has on one side of its path stays on one side. The path descends if
/// its mean Y between 2.5 and 7.5 d ahead of the sample's tip is below that between 2.5 and 7.5 d behind it.
///
/// A tip that is one of several sites at the same X, all with as many lost bonds, is in the middle of them, so that a
/// state that is its own mirror image has its axis on the grid's.
class NearTipSampler
{
public:
  static constexpr std::size_t n_blocks = 4;

  /// The lattice must outlive this object.
  NearTipSampler(const lattice::TriangularLattice &lattice, const lattice::Material &material,
                 const NearTipOptions &options);

  /// To be called at equal intervals of time, wherever the tip is. @param tip its place
  /// @return the sample, until the next call; null where none is taken: away from the stretch between X_begin and
  /// X_end, or because the tip has rested for the last ten calls and is no running one
  const NearTipSample *sample(const lattice::State &state, std::size_t tip);

  /// Whether sample() looks at the sheet if the tip is there, unless the tip rests.
  bool looks_at(std::size_t tip) const;
  /// The rows that it then looks at.
  lattice::Rows rows_around(std::size_t tip) const;

  /// Folds the last samples by what is known of the path. To be called once, when there is no more to come.
  void finish();

  std::size_t samples() const { return taken_; }
  const NearTipGrid &grid() const { return grid_; }
  /// Mean over all samples.
  NearTipField plain() const { return plain_.mean(); }
  /// Folded mean over all samples that are folded already.
  NearTipField folded() const;
  /// Folded sums of one block.
  const NearTipSums &folded_block(std::size_t block) const { return folded_[block]; }

  /// Saves or loads the samples and what is pending; see Simulation. @throws std::invalid_argument for what cannot be
  /// of this sheet
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
      lattice::require_archived(folded_.size() == n_blocks && n_pending <= path_.size(),
                                "`n_pending` samples are more than were taken");
      pending_.assign(n_pending, {0., 0., 0, NearTipSums(grid_), {}});
    }
    archive("pending", pending_);
    archive("last_tip", last_tip_);
    archive("calls_at_rest", calls_at_rest_);
    archive("taken", taken_);
    if constexpr (Archive::loads)
    {
      lattice::require_archived(taken_ <= path_.size() && n_pending <= taken_,
                                "`taken` samples are not as many as there can be");
      lattice::require_archived(!last_tip_ || (*last_tip_ < lattice_.n_places() && lattice_.is_site(*last_tip_)),
                                "`last_tip` is no site of the sheet");
      std::size_t folded = 0;
      for (const NearTipSums &sums : folded_)
        folded += sums.samples();
      lattice::require_archived(plain_.samples() == taken_ && folded == taken_ - n_pending,
                                "`samples` are not as many as were taken");
      for (const NearTipSample &sample : pending_)
        lattice::require_archived(sample.block < n_blocks && sample.sums.samples() == 1,
                                  "a pending sample is none of those that there can be");
    }
  }

private:
  struct Axis
  {
    Eigen::Vector2d reference, current; // of the tip [m]
  };
  Axis axis(const lattice::State &state, std::size_t tip) const;
  static lattice::Rows around(std::size_t centre, int before, int after, std::size_t n);
  lattice::Rows columns_around(std::size_t tip) const;
  NearTipSample look(const lattice::State &state, const Axis &axis, std::size_t tip, bool with_tensors);
  bool descends(double X) const;
  void fold_until(double X);

  const lattice::TriangularLattice &lattice_;
  lattice::Material material_;
  NearTipOptions options_;
  NearTipGrid grid_;
  lattice::SiteEvaluator evaluator_;
  lattice::StrainGradientFit gradient_fit_;
  std::vector<Eigen::Vector2d> path_; // of the tip at all calls, reference [m]
  NearTipSums plain_;
  std::vector<NearTipSums> folded_;   // a sum for each block
  std::deque<NearTipSample> pending_; // not folded yet
  std::optional<std::size_t> last_tip_;
  std::size_t calls_at_rest_ = 0;
  std::size_t taken_ = 0;
};

} // namespace latcon::analysis
