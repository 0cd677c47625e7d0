#include <cmath>
#include <limits>
#include <sstream>

#include <boost/math/distributions/students_t.hpp>

#include "verification/largest_error.h"
#include "verification/prestretch/cut_study.h"

namespace verification
{
namespace
{

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Student's t that a sample with so many degrees of freedom, one or more, exceeds in one case out of forty.
double students_t(std::size_t freedom)
{
  return boost::math::quantile(boost::math::students_t(static_cast<double>(freedom)), 0.975);
}

// Least squares of log(error) = log(factor) - order log(size), and how uncertain it is: the staircase that a lattice
// makes of a round rim is another for every radius, and scatters the errors.
struct PowerLaw
{
  double order;
  double order_deviation; // standard deviation of the order
  double expected;        // error at the size asked for
  double deviation;       // standard deviation of the logarithm of an error there
};

PowerLaw fit(const std::vector<double> &sizes, const std::vector<double> &errors, double asked)
{
  const auto n = static_cast<double>(errors.size());
  double x = 0., y = 0.;
  for (std::size_t i = 0; i < errors.size(); ++i)
  {
    x += std::log(sizes[i]) / n;
    y += std::log(errors[i]) / n;
  }
  double xx = 0., xy = 0.;
  for (std::size_t i = 0; i < errors.size(); ++i)
  {
    xx += std::pow(std::log(sizes[i]) - x, 2);
    xy += (std::log(sizes[i]) - x) * (std::log(errors[i]) - y);
  }
  const double slope = xy / xx, away = std::log(asked) - x;
  double residual = 0.;
  for (std::size_t i = 0; i < errors.size(); ++i)
    residual += std::pow(std::log(errors[i]) - y - slope * (std::log(sizes[i]) - x), 2);
  const double scatter = std::sqrt(residual / (n - 2.));
  return {-slope, scatter / std::sqrt(xx), std::exp(y + slope * away),
          scatter * std::sqrt(1. + 1. / n + away * away / xx)};
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
  Judge(const Subject &subject, const CutStudy &study, const Eigen::Matrix2d &F, const std::vector<CutResult> &results)
    : subject_(subject), study_(study), results_(results), is_hole_(study.name == "hole"),
      where_(subject.name + ": " + study.name + ", F = " + in_words(F) + ", ")
  {
    largest_ = size_text(study.sizes.back());
  }

  Results judged() const
  {
    Results rows;
    // Without an equilibrium of the local law there is no number, and the rows fail.
    for (const CutResult &result : results_)
      if (!result.errors && (result.law == "local" || result.law == "local-moved"))
        rows.add(not_computed("prestretch", where_ + "local law at " + size_text(result.size), result.failure));
    const std::vector<double> displacement = series("local", &CutErrors::displacement);
    const PowerLaw all = fit(study_.sizes, displacement, study_.sizes.back());
    // At a rim the lattice differs from the continuum by O(d), which is the least order there. About the tip of a
    // notch, where the local law has no bounded stretch, no order is known beforehand.
    Result order{"prestretch", where_ + "order of the displacement's error in " + (is_hole_ ? "d/R" : "d/length"),
                 "1",          all.order,
                 {},           {},
                 {},           {}};
    if (is_hole_)
    {
      order.theory = 1.;
      order.error = one_sided(1. - all.order);
      order.tolerance = students_t(displacement.size() - 2) * all.order_deviation;
    }
    rows.add(order);
    const double allowed = add_expected(rows, "displacement, rms at " + largest_, displacement);
    // About a tip stresses and the reactions that they leave fall too slowly for a fit to foretell them.
    add_expected(rows, "stress, rms", series("local", &CutErrors::stress), is_hole_);

    // What the place of rim and tip is not known better than: half the recession, half a spacing.
    const std::optional<CutErrors> here = errors_of("local", study_.sizes.back());
    const std::optional<CutErrors> moved = errors_of("local-moved", study_.sizes.back());
    for (const auto &[quantity, error] :
         {std::pair("stress, all in one", &CutErrors::stress_scale), std::pair("energy", &CutErrors::energy),
          std::pair("reactions", &CutErrors::reaction), std::pair("shape of the cut", &CutErrors::shape)})
      add(rows, quantity, here ? std::abs((*here).*error) : unknown,
          error == &CutErrors::reaction && !is_hole_
            ? std::nullopt
            // cppcheck-suppress knownConditionTrueFalse ; a notch is asked about too, of all but its reactions
            : std::optional<double>(here && moved ? (is_hole_ ? 0.5 : 1.) * std::abs((*moved).*error - (*here).*error)
                                                  : unknown));

    for (const auto &[law, kind] : {std::pair(std::string("lattice"), Law::lattice_gradient),
                                    std::pair(std::string("isotropic"), Law::isotropic_gradient),
                                    std::pair(std::string("mooney-rivlin"), Law::mooney_rivlin)})
      if (const CutResult *other = find(law, study_.sizes.back()))
      {
        const std::string name =
          law == "mooney-rivlin" ? "plane-stress Mooney-Rivlin" : "with the " + law + " gradient energy";
        const std::optional<double> tolerance =
          kind == Law::mooney_rivlin || !is_hole_ ? std::nullopt : subject_.tolerance(kind, allowed);
        if (other->errors)
          add(rows, name + ": displacement", other->errors->displacement, tolerance);
        else if (tolerance)
          rows.add(not_computed("prestretch", where_ + name, other->failure));
        else
          add(rows, name + ": no equilibrium: " + other->failure, {}, {});
      }
    return rows;
  }

  // Says which laws have an equilibrium, and how far off they are.
  Results reported() const
  {
    Results rows;
    for (const CutResult &result : results_)
      if (result.size == study_.sizes.back() && result.law != "local-nominal")
        add(rows, result.law + (result.errors ? ": displacement" : ": no equilibrium: " + result.failure),
            result.errors ? std::optional<double>(result.errors->displacement) : std::nullopt, {});
    return rows;
  }

private:
  std::string size_text(double size) const
  {
    std::ostringstream text;
    text << (is_hole_ ? "R/d" : "length/d") << " = " << size;
    return text.str();
  }

  void add(Results &rows, const std::string &quantity, std::optional<double> error,
           std::optional<double> tolerance) const
  {
    rows.add({"prestretch", where_ + quantity, "1", {}, {}, {}, error, tolerance});
  }

  // The error at the largest size beside what the others let one expect there, as far as their scatter makes it
  // uncertain.
  // @return what is allowed
  double add_expected(Results &rows, const std::string &quantity, const std::vector<double> &errors,
                      bool checked = true) const
  {
    const PowerLaw coarser = fit(study_.sizes, {errors.begin(), errors.end() - 1}, study_.sizes.back());
    const double allowed = coarser.expected * std::exp(students_t(errors.size() - 3) * coarser.deviation);
    rows.add({"prestretch",
              where_ + quantity,
              "1",
              {},
              {},
              coarser.expected,
              errors.back(),
              checked ? std::optional<double>(allowed) : std::nullopt});
    return allowed;
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

  const Subject &subject_;
  const CutStudy &study_;
  const std::vector<CutResult> &results_;
  bool is_hole_;
  std::string where_, largest_;
};

} // namespace

ClaimOutcome cut_claim(const Subject &subject, const CutStudy &study)
{
  ClaimOutcome outcome;
  Table &table = outcome.table(study.name, {"shells", "F_xx", "F_yy", "law", study.name == "hole" ? "R/d" : "length/d",
                                            "displacement", "stress", "energy", "reaction", "shape", "displacement_all",
                                            "displacement_max", "cauchy_stress", "stress_scale", "residual", "unknowns",
                                            "fem_error"});
  const auto compare_at = [&](const Eigen::Matrix2d &F)
  {
    const std::vector<CutResult> results = compare_sizes(subject, study, F);
    for (const CutResult &r : results)
    {
      if (r.law == "local-moved" || r.law == no_lattice)
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

} // namespace verification
