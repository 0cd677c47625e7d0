#include <array>
#include <cmath>

#include <Eigen/LU>
#include <boost/math/distributions/students_t.hpp>

#include "support/dense.h"
#include "support/largest_error.h"
#include "verification/bridge/equivalent_sheet.h"
#include "verification/claims/prestretch/prestretch_claim.h"
#include "verification/claims/rows.h"
#include "verification/claims/states.h"

namespace latcon::claims
{
namespace
{

// Least squares with the standard errors of its parameters.
struct Fit
{
  Eigen::VectorXd parameter, uncertainty; // exceeded in one case of 20

  // @param terms a column for each parameter, fewer than rows
  Fit(const Eigen::MatrixXd &terms, const Eigen::VectorXd &values)
    : parameter(support::least_squares(terms, values)), covariance(((terms.transpose() * terms).inverse())),
      freedom(static_cast<double>(terms.rows() - terms.cols()))
  {
    scatter = std::sqrt((values - terms * parameter).squaredNorm() / freedom);
    uncertainty =
      boost::math::quantile(boost::math::students_t(freedom), 0.975) * scatter * covariance.diagonal().cwiseSqrt();
  }

  Eigen::MatrixXd covariance; // over the square of the scatter
  double freedom, scatter = 0.;
};

Eigen::VectorXd as_vector(const std::vector<double> &values)
{
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// log(error) = log(factor) - order log(size) [+ second log-linear term / size]. The rim is stair-stepped differently
// for each radius, so errors scatter.
Fit power_law(const std::vector<double> &sizes, const std::vector<double> &errors, bool second_order)
{
  const Eigen::VectorXd size = as_vector(sizes);
  Eigen::MatrixXd terms(size.size(), second_order ? 3 : 2);
  terms.col(0).setOnes();
  terms.col(1) = -size.array().log();
  if (second_order)
    terms.col(2) = size.cwiseInverse();
  return {terms, as_vector(errors).array().log().matrix()};
}

// error = limit + first / size + second / size^2, whose scatter falls as 1 / size.
Fit limit_law(const std::vector<double> &sizes, const std::vector<double> &errors)
{
  const Eigen::VectorXd size = as_vector(sizes);
  Eigen::MatrixXd terms(size.size(), 3);
  terms.col(0) = size;
  terms.col(1).setOnes();
  terms.col(2) = size.cwiseInverse();
  return {terms, as_vector(errors).cwiseProduct(size)};
}

double geometric_mean(const std::vector<double> &values)
{
  double sum = 0.;
  for (const double value : values)
    sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

class Judge
{
public:
  Judge(const bridge::Subject &subject, const CutStudy &study, const Eigen::Matrix2d &F,
        const std::vector<CutResult> &results, output::Results &rows)
    : subject_(subject), study_(study), F_(F), results_(results), is_hole_(study.name == "hole"),
      rows_(rows, "prestretch", subject.name + ": " + study.name + ", " + state_name(F) + ", ")
  {
  }

  void judge() const
  {
    // Without an equilibrium of the local law the rows fail.
    for (const CutResult &result : results_)
      if (!result.errors && result.law.rfind("local", 0) == 0)
        rows_.add_not_computed("local law at " + size_text(result.size), result.failure);
    const std::vector<double> displacement = series(&CutErrors::displacement);
    add_orders(displacement);
    const output::Tolerance allowed = add_expected("displacement, rms at " + judged_sizes(), displacement, place());
    // In a layer of the width d about a rim stresses have an error of order one. About a tip they and the reactions
    // that they leave fall too slowly to be extrapolated by a fit.
    constexpr double of_layer = 0.15;
    (void)add_expected("stress, rms", series(&CutErrors::stress), of_layer / std::sqrt(study_.sizes.back()), is_hole_);

    for (const Scalar &scalar : scalars)
      add(scalar.name, std::abs(at_largest("local", scalar.error)), place_allowance(scalar));
    add_network();

    for (const auto &[law, kind] : {std::pair(std::string("lattice"), bridge::Law::lattice_gradient),
                                    std::pair(std::string("isotropic"), bridge::Law::isotropic_gradient)})
      if (const CutResult *other = find(law, study_.sizes.back()))
      {
        const std::string name = "with the " + law + " gradient energy";
        if (other->errors)
          add(name + ": displacement", other->errors->displacement, is_hole_ ? allowed : output::Tolerance(),
              subject_.judges(kind));
        else
          add_missing(name, other->failure, is_hole_ && subject_.judges(kind));
      }
  }

private:
  // Quantities of the whole sheet.
  struct Scalar
  {
    const char *name;
    double CutErrors::*error;
    double at_notch; // ceiling of the tolerance at a notch, over d/2 of the length
  };
  // The mouth of a notch opens in proportion to its length. Of an edge crack of length a in a sheet of 4 a by 4 a the
  // energy and what follows from it change by 2 (1.12^2 pi / 16) of the change of length at most.
  static constexpr std::array<Scalar, 4> scalars{
    {{"stress amplitude: least-squares scale factor minus 1", &CutErrors::stress_scale, 0.5},
     {"energy", &CutErrors::energy, 0.5},
     {"reactions", &CutErrors::reaction, 0.5},
     {"shape of the cut", &CutErrors::shape, 1.}}};

  // Distance to which rim or tip are known, over the size of the cut: of a rim no more than its recession, of a tip
  // half a spacing. No solver has a part in it.
  double place() const
  {
    const double rim = is_hole_ ? bridge::rim_recession(subject_.sheet(), subject_.material) / subject_.spacing : 0.5;
    return rim / study_.sizes.back();
  }

  // Change of the local law if rim or tip move by the uncertainty of their position: half the recession and what it
  // gains where the rim is stretched; half a spacing.
  output::Tolerance place_allowance(const Scalar &scalar) const
  {
    const double moved = at_largest("local-moved", scalar.error, &CutResult::from_local);
    if (!is_hole_)
      return output::limited(moved, 0.02 * place(), scalar.at_notch * place(),
                             "change of the local law if the tip moves by d/2");
    const lattice::TriangularLattice sheet = subject_.sheet();
    // Strains along a rim are on average three times those of the sheet, whose Poisson's ratio is 1/3.
    const double hoop = 1. + 3. * support::one_sided(0.5 * F_.trace() - 1.);
    const double gain = bridge::stretched_rim_recession(sheet, subject_.material, hoop) /
                          bridge::rim_recession(sheet, subject_.material) -
                        1.;
    return output::limited((0.5 + gain) * moved, 0.02 * place(), place(),
                           "change of the local law if the rim moves by half its recession (H.10), and by what this "
                           "gains with the stretch of the rim");
  }

  // Orders, and limits for d/R = 0, with terms of second order. At a rim the lattice differs from the continuum by
  // O(d), which is the least order there; with few radii the scatter hides it. About the tip of a notch, where the
  // local law has no bounded stretch, no order is known beforehand.
  void add_orders(const std::vector<double> &displacement) const
  {
    constexpr std::size_t enough = 8;
    const bool is_judged = is_hole_ && study_.sizes.size() >= enough;
    const Fit order = power_law(study_.sizes, displacement, is_judged);
    const std::string name = std::string("order of the displacement's error in ") + (is_hole_ ? "d/R" : "d/length");
    if (!is_judged)
      return rows_.add(name, "1", of_lattice(order.parameter(1)));
    rows_.add(name + ", with second order", "1", of_lattice(order.parameter(1), 1.),
              support::one_sided(1. - order.parameter(1)),
              output::limited(order.uncertainty(1), 0.05, 0.5, "uncertainty of the fit, one case of 20"));
    const auto add_limit = [&](const std::string &quantity, const std::vector<double> &errors)
    {
      const Fit fit = limit_law(study_.sizes, errors);
      rows_.add(quantity + ", limit of the error for d/R = 0", "1", of_lattice(fit.parameter(0), 0.),
                std::abs(fit.parameter(0)),
                output::limited(fit.uncertainty(0), 1e-4, 2e-3,
                                "uncertainty of a fit with terms of first and second order, one case of 20"));
    };
    add_limit("displacement, rms", displacement);
    for (const Scalar &scalar : scalars)
      add_limit(scalar.name, series(scalar.error));
  }

  // The network is the mean of the local law over rotations of the lattice: to first order of the anisotropy it lies
  // midway between the law and the law turned by 30 degrees (theory-comparison.md, eq. (H.17)). Against the lattice it
  // is off by half the distance of these two, which is reported.
  void add_network() const
  {
    const bool is_judged = subject_.judges(bridge::Law::mooney_rivlin_network);
    const auto failure = [](const CutResult *result) { return result != nullptr ? result->failure : "not computed"; };
    const CutResult *network = find("network", study_.sizes.back());
    if (network == nullptr || !network->errors || !network->from_middle)
      return add_missing("network", failure(network), is_judged);
    // First order: half the distance of the two laws. Second order: its products with the first order in stress, not
    // small where all bonds are alike in length, and reported there.
    const bool is_small = subject_.material.coordination() > 6;
    const auto first_order = [&](double CutErrors::*part)
    { return 0.5 * at_largest("local-turned", part, &CutResult::from_local); };
    const double in_stress = first_order(&CutErrors::stress);
    const auto add_middle = [&](const std::string &name, double CutErrors::*part)
    {
      const output::Tolerance second = output::limited(4. * in_stress * (first_order(part) + in_stress), 2e-4, 8e-3,
                                                       "four times the products of first order in the anisotropy");
      add("network: " + name + ", against the mean of the local law at 0 and 30 degrees", (*network->from_middle).*part,
          is_small ? second : output::Tolerance(), is_judged);
    };
    add_middle("displacement", &CutErrors::displacement);
    add_middle("stress, rms", &CutErrors::stress);
    // The shape is that of the rim, where the dependence on direction exceeds its mean over the sheet.
    for (const Scalar &scalar : scalars)
      if (scalar.error != &CutErrors::shape)
        add_middle(scalar.name, scalar.error);

    add("network: displacement", network->errors->displacement);
    add("network: stress, rms", network->errors->stress);
    for (const Scalar &scalar : scalars)
      add(std::string("network: ") + scalar.name, std::abs((*network->errors).*scalar.error));
    const CutResult *gradient = find("network-gradient", study_.sizes.back());
    const std::string name = "network with its gradient energy: displacement";
    if (gradient != nullptr && gradient->errors)
      add(name, gradient->errors->displacement);
    else
      add_missing(name, failure(gradient), is_judged);
  }

  // Why a law has no equilibrium.
  void add_missing(const std::string &name, const std::string &failure, bool is_judged) const
  {
    const std::string reason = failure.substr(0, failure.find('\n')); // the steps of the solver follow
    if (is_judged)
      rows_.add_not_computed(name, failure);
    else
      rows_.add(name + ": no equilibrium: " + reason, "1", {});
  }

  std::string size_text(double size) const { return support::text_of(is_hole_ ? "R/d" : "length/d", " = ", size); }

  void add(const std::string &quantity, double error, const output::Tolerance &tolerance = {},
           bool is_judged = true) const
  {
    rows_.add(quantity, "1", {}, error, tolerance, is_judged);
  }

  std::string judged_sizes() const
  {
    if (study_.n_judged == 1)
      return size_text(study_.sizes.back());
    return support::text_of(size_text(study_.sizes[study_.sizes.size() - study_.n_judged]), " to ",
                            study_.sizes.back());
  }

  // The errors at the largest sizes against the extrapolation of the others, within its scatter and below a ceiling.
  // @return tolerance at the largest size
  output::Tolerance add_expected(const std::string &quantity, const std::vector<double> &errors, double ceiling,
                                 bool checked = true) const
  {
    const auto n = static_cast<std::ptrdiff_t>(errors.size() - study_.n_judged);
    // Two parameters: a third, of second order, is not determined by radii of 8 d to 24 d, and extrapolates to nothing.
    const Fit smaller =
      power_law({study_.sizes.begin(), study_.sizes.begin() + n}, {errors.begin(), errors.begin() + n}, false);
    const auto expected = [&](double size)
    { return std::exp(smaller.parameter(0) - smaller.parameter(1) * std::log(size)); };
    // By chance one row of 40 may exceed its tolerance in a study of few sizes, of the some thirty rows about holes,
    // with all shells, states and shipped cases, none.
    const double one_of = study_.n_judged > 1 ? 1000. : 40.;
    const double quantile =
      boost::math::quantile(boost::math::complement(boost::math::students_t(smaller.freedom), 1. / one_of));
    // Largest geometric mean of some errors about a size.
    const auto allowed = [&](double size, std::size_t n_errors)
    {
      const Eigen::Vector2d at(1., -std::log(size));
      const double variance = 1. / static_cast<double>(n_errors) + at.dot(smaller.covariance * at);
      return output::limited(expected(size) * std::exp(quantile * smaller.scatter * std::sqrt(variance)), 0., ceiling,
                             "extrapolation of the smaller sizes and its scatter, one case of " +
                               std::to_string(static_cast<int>(one_of)));
    };
    const double size = geometric_mean({study_.sizes.begin() + n, study_.sizes.end()});
    rows_.add(quantity, "1", {{}, {}, expected(size)}, geometric_mean({errors.begin() + n, errors.end()}),
              checked ? allowed(size, study_.n_judged) : output::Tolerance());
    return allowed(study_.sizes.back(), 1);
  }

  const CutResult *find(const std::string &law, double size) const
  {
    for (const CutResult &result : results_)
      if (result.law == law && result.size == size)
        return &result;
    return nullptr;
  }

  // An error at the largest size, or a distance from another continuum; unknown where there is no equilibrium.
  double at_largest(const std::string &law, double CutErrors::*error,
                    std::optional<CutErrors> CutResult::*of = &CutResult::errors) const
  {
    return value(find(law, study_.sizes.back()), error, of);
  }
  static double value(const CutResult *found, double CutErrors::*error,
                      std::optional<CutErrors> CutResult::*of = &CutResult::errors)
  {
    return found != nullptr && found->*of ? (*(found->*of)).*error : unknown;
  }
  std::vector<double> series(double CutErrors::*error) const
  {
    std::vector<double> values;
    for (const double size : study_.sizes)
      values.push_back(value(find("local", size), error));
    return values;
  }

  const bridge::Subject &subject_;
  const CutStudy &study_;
  Eigen::Matrix2d F_;
  const std::vector<CutResult> &results_;
  bool is_hole_;
  Rows rows_;
};

} // namespace

ClaimOutcome cut_claim(const bridge::Subject &subject, const CutStudy &study)
{
  ClaimOutcome outcome;
  output::Table &table = outcome.table(
    study.name, {"shells", "F_xx", "F_yy", "law", study.name == "hole" ? "R/d" : "length/d", "displacement", "stress",
                 "energy", "reaction", "shape", "displacement_all", "displacement_max", "cauchy_stress", "stress_scale",
                 "residual", "unknowns", "fem_error"});
  const auto compare_at = [&](const Eigen::Matrix2d &F)
  {
    const std::vector<CutResult> results = compare_sizes(subject, study, F);
    for (const CutResult &r : results)
    {
      if (r.law == "local-moved" || r.law == "local-turned")
        continue;
      const CutErrors e = r.errors.value_or(CutErrors());
      table.add({subject.name, F(0, 0), F(1, 1), r.law, r.size, e.displacement, e.stress, std::abs(e.energy),
                 e.reaction_vector, e.shape, e.displacement_all, e.displacement_max, e.cauchy_stress, e.stress_scale,
                 r.residual, e.unknowns, e.fem});
    }
    output::Results rows; // none if one of them throws
    const Judge judge(subject, study, F, results, rows);
    judge.judge();
    outcome.results.add(rows);
  };
  for (const Eigen::Matrix2d &F : study.states)
    outcome.results.attempt("prestretch", subject.name + ": " + study.name + ", " + state_name(F),
                            [&] { compare_at(F); });
  return outcome;
}

} // namespace latcon::claims
