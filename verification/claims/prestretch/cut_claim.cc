#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include <boost/math/distributions/students_t.hpp>

#include "support/largest_error.h"
#include "verification/claims/prestretch/cut_study.h"

namespace latcon::claims
{
namespace
{

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Student's t, 97.5 % quantile, for one degree of freedom or more.
double students_t(std::size_t freedom)
{
  return boost::math::quantile(boost::math::students_t(static_cast<double>(freedom)), 0.975);
}

// Least squares of log(error) = log(factor) - order log(size). The staircase that a lattice makes of a round rim is
// another for every radius and scatters the errors.
class PowerLaw
{
public:
  PowerLaw(const std::vector<double> &sizes, const std::vector<double> &errors) : n_(static_cast<double>(sizes.size()))
  {
    for (std::size_t i = 0; i < sizes.size(); ++i)
    {
      x_ += std::log(sizes[i]) / n_;
      y_ += std::log(errors[i]) / n_;
    }
    double xy = 0.;
    for (std::size_t i = 0; i < sizes.size(); ++i)
    {
      xx_ += std::pow(std::log(sizes[i]) - x_, 2);
      xy += (std::log(sizes[i]) - x_) * (std::log(errors[i]) - y_);
    }
    slope_ = xy / xx_;
    double residual = 0.;
    for (std::size_t i = 0; i < sizes.size(); ++i)
      residual += std::pow(std::log(errors[i]) - y_ - slope_ * (std::log(sizes[i]) - x_), 2);
    scatter_ = std::sqrt(residual / (n_ - 2.));
  }

  double order() const { return -slope_; }
  // Largest error of the order, in 39 cases out of 40.
  double order_uncertainty() const { return students_t(freedom()) * scatter_ / std::sqrt(xx_); }
  double expected(double size) const { return std::exp(y_ + slope_ * (std::log(size) - x_)); }
  // Largest geometric mean of n errors about a size, in 39 cases out of 40.
  double allowed(double size, std::size_t n) const
  {
    const double away = std::log(size) - x_;
    const double deviation = scatter_ * std::sqrt(1. / static_cast<double>(n) + 1. / n_ + away * away / xx_);
    return expected(size) * std::exp(students_t(freedom()) * deviation);
  }

private:
  std::size_t freedom() const { return static_cast<std::size_t>(n_) - 2; }

  double n_, x_ = 0., y_ = 0., xx_ = 0.;
  double slope_, scatter_; // slope, and standard deviation of the logarithm of an error
};

double geometric_mean(const std::vector<double> &values)
{
  double sum = 0.;
  for (const double value : values)
    sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

std::string in_words(const Eigen::Matrix2d &F)
{
  std::ostringstream text;
  text.precision(3);
  text << "(" << F(0, 0) << ", " << F(1, 1) << ")";
  return text.str();
}

class Judge
{
public:
  Judge(const bridge::Subject &subject, const CutStudy &study, const Eigen::Matrix2d &F,
        const std::vector<CutResult> &results)
    : subject_(subject), study_(study), results_(results), is_hole_(study.name == "hole"),
      where_(subject.name + ": " + study.name + ", F = " + in_words(F) + ", ")
  {
    largest_ = size_text(study.sizes.back());
  }

  output::Results judged() const
  {
    output::Results rows;
    // Without an equilibrium of the local law the rows fail.
    for (const CutResult &result : results_)
      if (!result.errors && result.law.rfind("local", 0) == 0 && result.law != "local-nominal")
        rows.add(output::not_computed("prestretch", where_ + "local law at " + size_text(result.size), result.failure));
    const std::vector<double> displacement = series("local", &CutErrors::displacement);
    const PowerLaw all(study_.sizes, displacement);
    // At a rim the lattice differs from the continuum by O(d), which is the least order there. About the tip of a
    // notch, where the local law has no bounded stretch, no order is known beforehand.
    output::Result order{
      "prestretch", where_ + "order of the displacement's error in " + (is_hole_ ? "d/R" : "d/length"),
      "1",          all.order(),
      {},           {},
      {},           {}};
    if (is_hole_)
    {
      order.theory = 1.;
      order.error = support::one_sided(1. - all.order());
      order.tolerance = all.order_uncertainty();
    }
    rows.add(order);
    const double allowed = add_expected(rows, "displacement, rms at " + judged_sizes(), displacement);
    // About a tip stresses and the reactions that they leave fall too slowly to be extrapolated by a fit.
    const double allowed_stress = add_expected(rows, "stress, rms", series("local", &CutErrors::stress), is_hole_);

    for (const Scalar &scalar : scalars)
      add(rows, scalar.name, scalar_error("local", scalar), place_allowance(scalar));
    add_network(rows, allowed, allowed_stress);

    for (const auto &[law, kind] : {std::pair(std::string("lattice"), bridge::Law::lattice_gradient),
                                    std::pair(std::string("isotropic"), bridge::Law::isotropic_gradient),
                                    std::pair(std::string("mooney-rivlin"), bridge::Law::mooney_rivlin)})
      if (const CutResult *other = find(law, study_.sizes.back()))
      {
        const std::string name =
          law == "mooney-rivlin" ? "plane-stress Mooney-Rivlin" : "with the " + law + " gradient energy";
        const std::optional<double> tolerance =
          kind == bridge::Law::mooney_rivlin || !is_hole_ ? std::nullopt : subject_.tolerance(kind, allowed);
        if (other->errors)
          add(rows, name + ": displacement", other->errors->displacement, tolerance);
        else if (tolerance)
          rows.add(output::not_computed("prestretch", where_ + name, other->failure));
        else
          add(rows, name + ": no equilibrium: " + other->failure, {}, {});
      }
    return rows;
  }

  // Reports which laws have an equilibrium, and their errors.
  output::Results reported() const
  {
    output::Results rows;
    for (const CutResult &result : results_)
      if (result.size == study_.sizes.back() && result.law != "local-nominal")
        add(rows, result.law + (result.errors ? ": displacement" : ": no equilibrium: " + result.failure),
            result.errors ? std::optional<double>(result.errors->displacement) : std::nullopt, {});
    return rows;
  }

private:
  // Quantities of the whole sheet, and differences of two continua in them.
  struct Scalar
  {
    const char *name;
    double CutErrors::*error;
    double CutDistance::*distance;
  };
  static constexpr std::array<Scalar, 4> scalars{
    {{"stress, all in one", &CutErrors::stress_scale, &CutDistance::stress_scale},
     {"energy", &CutErrors::energy, &CutDistance::energy},
     {"reactions", &CutErrors::reaction, &CutDistance::reaction},
     {"shape of the cut", &CutErrors::shape, &CutDistance::shape}}};

  double scalar_error(const std::string &law, const Scalar &scalar) const
  {
    const std::optional<CutErrors> found = errors_of(law, study_.sizes.back());
    return found ? std::abs((*found).*scalar.error) : unknown;
  }

  double distance_from_local(const std::string &law, double CutDistance::*part) const
  {
    const CutResult *found = find(law, study_.sizes.back());
    return found != nullptr && found->from_local ? (*found->from_local).*part : unknown;
  }

  // Change of the local law if rim or tip move by the uncertainty of their position: half the recession, half a
  // spacing.
  double place_allowance(const Scalar &scalar) const
  {
    return (is_hole_ ? 0.5 : 1.) * distance_from_local("local-moved", scalar.distance);
  }

  // The network against the lattice: tolerance of the local law, plus the bound of the dependence on direction
  // (theory-comparison.md, eqs. (H.17) and (H.18)).
  void add_network(output::Results &rows, double allowed, double allowed_stress) const
  {
    const auto judged = [&](double CutDistance::*part, double of_local)
    {
      return subject_.tolerance(bridge::Law::mooney_rivlin_network,
                                of_local + distance_from_local("local-turned", part));
    };
    const CutResult *network = find("network", study_.sizes.back());
    if (network != nullptr && network->errors)
    {
      const double displacement = network->errors->displacement, stress = network->errors->stress;
      add(rows, "network: displacement", displacement, judged(&CutDistance::displacement, allowed));
      add(rows, "network: stress, rms", stress, is_hole_ ? judged(&CutDistance::stress, allowed_stress) : std::nullopt);
      const double square = 0.25 * std::pow(distance_from_local("local-turned", &CutDistance::stress), 2);
      for (const Scalar &scalar : scalars)
        add(rows, std::string("network: ") + scalar.name, scalar_error("network", scalar),
            scalar.error == &CutErrors::energy
              ? subject_.tolerance(bridge::Law::mooney_rivlin_network, place_allowance(scalar) + network->network_bound)
              : judged(scalar.distance, place_allowance(scalar) + square));
    }
    else
      add_missing(rows, "network", network);

    // The gradient energy spreads the stretch about a tip over l_d, which is no longer than the distance by which
    // "local-moved" moves the tip.
    const CutResult *gradient = find("network-gradient", study_.sizes.back());
    const std::string name = "network with its gradient energy: displacement";
    const double of_tip = is_hole_ ? 0. : distance_from_local("local-moved", &CutDistance::displacement);
    if (gradient != nullptr && gradient->errors)
      add(rows, name, gradient->errors->displacement, judged(&CutDistance::displacement, allowed + of_tip));
    else
      add_missing(rows, name, gradient);
  }

  void add_missing(output::Results &rows, const std::string &name, const CutResult *result) const
  {
    const std::string failure = result != nullptr ? result->failure : "not computed";
    if (subject_.tolerance(bridge::Law::mooney_rivlin_network, 0.))
      rows.add(output::not_computed("prestretch", where_ + name, failure));
    else
      add(rows, name + ": no equilibrium: " + failure, {}, {});
  }

  std::string size_text(double size) const
  {
    std::ostringstream text;
    text << (is_hole_ ? "R/d" : "length/d") << " = " << size;
    return text.str();
  }

  void add(output::Results &rows, const std::string &quantity, std::optional<double> error,
           std::optional<double> tolerance) const
  {
    rows.add({"prestretch", where_ + quantity, "1", {}, {}, {}, error, tolerance});
  }

  std::string judged_sizes() const
  {
    if (study_.n_judged == 1)
      return largest_;
    std::ostringstream text;
    text << size_text(study_.sizes[study_.sizes.size() - study_.n_judged]) << " to " << study_.sizes.back();
    return text.str();
  }

  // The errors at the largest sizes against the extrapolation of the others, within its scatter.
  // @return tolerance at the largest size
  double add_expected(output::Results &rows, const std::string &quantity, const std::vector<double> &errors,
                      bool checked = true) const
  {
    const auto n = static_cast<std::ptrdiff_t>(errors.size() - study_.n_judged);
    const PowerLaw smaller({study_.sizes.begin(), study_.sizes.begin() + n}, {errors.begin(), errors.begin() + n});
    const double size = geometric_mean({study_.sizes.begin() + n, study_.sizes.end()});
    rows.add({"prestretch",
              where_ + quantity,
              "1",
              {},
              {},
              smaller.expected(size),
              geometric_mean({errors.begin() + n, errors.end()}),
              checked ? std::optional<double>(smaller.allowed(size, study_.n_judged)) : std::nullopt});
    return smaller.allowed(study_.sizes.back(), 1);
  }

  const CutResult *find(const std::string &law, double size) const
  {
    for (const CutResult &result : results_)
      if (result.law == law && result.size == size)
        return &result;
    return nullptr;
  }

  // None also where there is no equilibrium.
  std::optional<CutErrors> errors_of(const std::string &law, double size) const
  {
    const CutResult *found = find(law, size);
    return found != nullptr ? found->errors : std::nullopt;
  }

  std::vector<double> series(const std::string &law, double CutErrors::*error) const
  {
    std::vector<double> values;
    for (const double size : study_.sizes)
    {
      const std::optional<CutErrors> found = errors_of(law, size);
      values.push_back(found ? (*found).*error : unknown);
    }
    return values;
  }

  const bridge::Subject &subject_;
  const CutStudy &study_;
  const std::vector<CutResult> &results_;
  bool is_hole_;
  std::string where_, largest_;
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
      if (r.law == "local-moved" || r.law == "local-turned" || r.law == no_lattice)
        continue;
      CutErrors e{unknown, unknown, unknown, unknown, unknown, unknown,
                  unknown, unknown, unknown, unknown, unknown, unknown};
      if (r.errors)
        e = *r.errors;
      table.add({subject.name, F(0, 0), F(1, 1), r.law, r.size, e.displacement, e.stress, std::abs(e.energy),
                 e.reaction_vector, e.shape, e.displacement_all, e.displacement_max, e.cauchy_stress, e.stress_scale,
                 r.residual, e.unknowns, e.fem});
    }
    const Judge judge(subject, study, F, results);
    outcome.results.add(study.is_reported ? judge.reported() : judge.judged());
  };
  for (const Eigen::Matrix2d &F : study.states)
    outcome.results.attempt("prestretch", subject.name + ": " + study.name + ", F = " + in_words(F),
                            [&] { compare_at(F); });
  return outcome;
}

} // namespace latcon::claims
