#include "verification/claims/disorder/disorder_claim.h"

#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>

#include "lattice/energy.h"
#include "lattice/relaxation.h"
#include "support/largest_error.h"
#include "verification/claims/bonds.h"
#include "verification/claims/claim_list.h"

namespace latcon::claims
{
namespace
{

using Kind = lattice::Distribution::Kind;

// Also of functions whose derivatives are singular at an end, as those of the density of a Weibull distribution.
double integral(double from, double to, const std::function<double(double)> &f)
{
  static thread_local boost::math::quadrature::tanh_sinh<double> rule; // integrate() is not const
  return rule.integrate(f, from, to, 1e-12);
}

// So small that the laws are linear, so large that energies have nine digits: means over both signs are taken, hence
// ratios of energies are off by the order of its square, and of that the share that is not homogeneous.
constexpr double load_strain = 1e-3;
constexpr double nonlinearity_tolerance =
  100. * load_strain * load_strain; // psi'''' / psi'' is below this number times 12 for rubber

// Standard errors of a mean that is normally distributed, exceeded with a probability of 6e-7.
constexpr double normal_quantile = 5., exceeded = 6e-7;

// One sheet at one load.
struct Measured
{
  double relaxed, homogeneous; // energies [J/m], means over both signs of the load
  double reuss;                // lower bound on their ratio
};

class DisorderedSheets
{
public:
  DisorderedSheets(const bridge::Subject &subject, const DisorderOptions &options, lattice::Disorder disorder,
                   const Rows &rows)
    : subject_(subject), options_(options), disorder_(std::move(disorder)), rows_(rows),
      sheet_(subject.spacing, static_cast<double>(options.columns) * subject.spacing,
             std::sqrt(3.) / 2. * (static_cast<double>(options.columns) * subject.spacing),
             lattice::Orientation::rows_along_crack, {true, true}),
      material_(lattice::without_dashpots(subject.material)),
      medium_(effective_medium(sheet_, material_, disorder_.stiffness))
  {
  }

  void run(ClaimOutcome &outcome)
  {
    Eigen::Matrix2d shear;
    shear << 1., 0., 0., -1.;
    const Eigen::Matrix2d dilation = Eigen::Matrix2d::Identity();
    std::vector<Measured> dilated, sheared;
    for (std::size_t i = 0; i < options_.n_sheets; ++i)
    {
      material_.disorder = disorder_;
      material_.disorder.seed += i;
      dilated.push_back(measure(dilation, true));
      sheared.push_back(measure(shear, false));
    }
    add_factor_rows();
    add_modulus_rows("bulk modulus", dilation, dilated, outcome);
    add_modulus_rows("shear modulus", shear, sheared, outcome);
  }

private:
  // Energy of an undisordered bond of a kind under a strain, over a common factor.
  double weight(std::size_t kind, const Eigen::Matrix2d &load) const
  {
    const lattice::Shell *shell = material_.shell(kind);
    if (shell == nullptr)
      return 0.;
    const Eigen::Vector2d n = sheet_.bond_vector(kind).normalized();
    const double stretching = n.dot(load * n);
    return lattice::cross_section(*shell, sheet_) * sheet_.rest_length(kind) * lattice::stiffness(shell->law, 1.) *
           stretching * stretching;
  }

  Measured measure(const Eigen::Matrix2d &load, bool counts_factors)
  {
    Measured result{0., 0., 0.};
    double all = 0., stiff = 0., soft = 0.;
    for (const double sign : {1., -1.})
    {
      lattice::State state = lattice::homogeneous_state(
        sheet_, material_, Eigen::Matrix2d::Identity() + sign * load_strain * load, lattice::Edges::free);
      options_.planted(state);
      if (sign > 0.)
        for (const lattice::Bond &bond : bonds(state, sheet_))
        {
          const double factor = state.stiffness.of(bond.near, bond.kind), w = weight(bond.kind, load);
          all += w;
          stiff += w * factor;
          soft += w / factor;
          if (!counts_factors)
            continue;
          n_factors_ += 1.;
          sum_ += factor - 1.;
          squares_ += (factor - 1.) * (factor - 1.);
        }
      result.homogeneous += lattice::elastic_energy(state, sheet_, material_);
      const double force =
        lattice::cross_section(material_.nearest, sheet_) * lattice::stiffness(material_.nearest.law, 1.) * load_strain;
      // Energy is off by the square of the forces that are left, over the stiffness of the longest wave.
      lattice::relax(state, sheet_, material_, 1e-8 * force);
      result.relaxed += lattice::elastic_energy(state, sheet_, material_);
    }
    result.reuss = all / soft * (all / stiff);
    return result;
  }

  void add_factor_rows() const
  {
    const double width = disorder_.stiffness.width(), mean = 1. + sum_ / n_factors_;
    const double found = std::sqrt(squares_ / n_factors_);
    const double fourth = mean_over(disorder_.stiffness, [](double factor) { return std::pow(factor - 1., 4); });
    const double root = std::sqrt(n_factors_);
    rows_.add("mean factor of the stiffness of the bonds of all sheets", "1", of_lattice(mean, 1.), std::abs(mean - 1.),
              {normal_quantile * width / root, "five standard errors of a mean over all bonds"});
    rows_.add("standard deviation of the factor", "1", of_lattice(found, width), support::relative_error(found, width),
              {0.5 * normal_quantile * std::sqrt(fourth / std::pow(width, 4) - 1.) / root,
               "five standard errors, from the fourth moment of the distribution"});
  }

  void add_modulus_rows(const std::string &modulus, const Eigen::Matrix2d &load, const std::vector<Measured> &measured,
                        ClaimOutcome &outcome) const
  {
    double theory = 0., all = 0., share = 0.;
    for (std::size_t kind = 0; kind < lattice::n_bond_kinds; ++kind)
    {
      const double w = weight(kind, load);
      all += w;
      theory += w * medium_.factor[kind];
      share += w * medium_.share[kind];
    }
    theory /= all;
    share /= all;
    const double n = static_cast<double>(measured.size()), width = disorder_.stiffness.width();
    double relaxed = 0., homogeneous = 0., squares = 0.;
    support::LargestError excess;
    for (const Measured &one : measured)
    {
      relaxed += one.relaxed;
      homogeneous += one.homogeneous;
      const double ratio = one.relaxed / one.homogeneous;
      excess.add(support::largest_of({support::one_sided(ratio - 1.), support::one_sided(one.reuss - ratio)}), ratio);
    }
    const double mean = relaxed / homogeneous;
    output::Table &table = outcome.table(
      "disorder", {"shells", "modulus", "sheet", "ratio [1]", "reuss [1]", "effective_medium [1]", "width [1]"});
    for (std::size_t i = 0; i < measured.size(); ++i)
    {
      const double ratio = measured[i].relaxed / measured[i].homogeneous;
      squares += (ratio - mean) * (ratio - mean);
      table.add({subject_.name, modulus, static_cast<double>(i), ratio, measured[i].reuss, theory, width});
    }
    // The ratio is of second order in the factors, whose squares scatter by less than twice their mean: more scatter
    // of the sheets does not loosen the tolerance.
    // The same quantile for a standard error that is estimated from n values.
    const double quantile =
      boost::math::quantile(boost::math::complement(boost::math::students_t(n - 1.), 0.5 * exceeded));
    const double sampling = quantile * support::smallest_of({std::sqrt(squares / (n * (n - 1.))),
                                                             2. * width * width / std::sqrt(n_factors_)});
    // Pairs of bonds are what the effective medium leaves out, in the fourth order; the next orders are below the fifth
    // power of the width (theory-comparison.md, eq. (H.24)).
    const double of_pairs = 0.5 * share * (1. - share) * std::pow(width, 4);
    const double order = of_pairs + std::pow(width, 5);
    const double nonlinear = nonlinearity_tolerance * (1. - theory);
    rows_.add(modulus + " over that of homogeneous deformation, beyond the bounds of Voigt and Reuss, worst sheet", "1",
              of_lattice(excess.value()), excess,
              {nonlinear, "laws that are not linear: 100 times the square of the strain, times the reduction"});
    rows_.add("reduction of the " + modulus +
                " by disorder, mean over sheets against effective medium, error over the modulus",
              "1", of_lattice(1. - mean, 1. - theory), std::abs(mean - theory),
              {sampling + order + nonlinear,
               "standard errors of the mean over sheets (Student, 6e-7), at most those of squares of factors; pairs of "
               "bonds (H.24) and the fifth power of the width; laws that are not linear"});
  }

  const bridge::Subject &subject_;
  const DisorderOptions &options_;
  lattice::Disorder disorder_;
  const Rows &rows_;
  lattice::TriangularLattice sheet_;
  lattice::Material material_;
  EffectiveMedium medium_;
  double n_factors_ = 0., sum_ = 0., squares_ = 0.; // of the factors less 1
};

} // namespace

double mean_over(const lattice::Distribution &distribution, const std::function<double(double)> &function)
{
  const double width = distribution.width();
  if (distribution.kind() == Kind::uniform)
  {
    const double half = std::sqrt(3.) * width;
    return integral(1. - half, 1. + half, function) / (2. * half);
  }
  if (distribution.kind() == Kind::normal)
  {
    constexpr double c = lattice::Distribution::cut_off;
    const auto weight = [](double z) { return std::exp(-0.5 * z * z); };
    const double norm = integral(-c, c, weight);
    const double variance = integral(-c, c, [&](double z) { return weight(z) * z * z; }) / norm;
    const double scale = width / std::sqrt(variance);
    return integral(-c, c, [&](double z) { return weight(z) * function(1. + scale * z); }) / norm;
  }
  // The shape by bisection, from moments.
  double low = 1., high = 2. / width;
  for (int i = 0; i < 100; ++i)
  {
    const double shape = 0.5 * (low + high);
    const double ratio = std::tgamma(1. + 2. / shape) / std::pow(std::tgamma(1. + 1. / shape), 2);
    (ratio > 1. + width * width ? low : high) = shape;
  }
  const double shape = low, scale = 1. / std::tgamma(1. + 1. / shape);
  const double end = std::pow(40., 1. / shape); // beyond which e^-40 is left
  const auto density = [&](double s) { return shape * std::pow(s, shape - 1.) * std::exp(-std::pow(s, shape)); };
  return integral(0., end, [&](double s) { return density(s) * function(scale * s); });
}

EffectiveMedium effective_medium(const lattice::TriangularLattice &sheet, const lattice::Material &material,
                                 const lattice::Distribution &distribution)
{
  using lattice::n_bond_kinds;
  EffectiveMedium medium;
  std::array<double, n_bond_kinds> stiffness{}; // A0 psi'' / l per sheet thickness [N/m^2]
  std::array<Eigen::Matrix2d, n_bond_kinds> direction;
  for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
    if (const lattice::Shell *shell = material.shell(kind))
    {
      const Eigen::Vector2d n = sheet.bond_vector(kind).normalized();
      direction[kind] = n * n.transpose();
      stiffness[kind] =
        lattice::cross_section(*shell, sheet) * lattice::stiffness(shell->law, 1.) / sheet.rest_length(kind);
      medium.factor[kind] = 1.;
    }
  const bool along_x = sheet.orientation() == lattice::Orientation::rows_along_crack;
  const std::size_t n_x = along_x ? sheet.columns() : sheet.rows(), n_y = along_x ? sheet.rows() : sheet.columns();
  const auto find_shares = [&]
  {
    medium.share = {};
    for (std::size_t i = 0; i < n_x; ++i)
      for (std::size_t j = 0; j < n_y; ++j)
      {
        if (i + j == 0)
          continue; // a translation
        const Eigen::Vector2d K(2. * M_PI * static_cast<double>(i) / sheet.length(),
                                2. * M_PI * static_cast<double>(j) / sheet.height());
        std::array<Eigen::Matrix2d, n_bond_kinds> of_kind;
        Eigen::Matrix2d dynamical = Eigen::Matrix2d::Zero();
        for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
          if (medium.factor[kind] > 0.)
          {
            of_kind[kind] = medium.factor[kind] * stiffness[kind] * 2. *
                            (1. - std::cos(K.dot(sheet.bond_vector(kind)))) * direction[kind];
            dynamical += of_kind[kind];
          }
        const Eigen::Matrix2d inverse = dynamical.inverse();
        for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
          if (medium.factor[kind] > 0.)
            medium.share[kind] += (of_kind[kind] * inverse).trace() / static_cast<double>(n_x * n_y);
      }
  };
  // The shares depend on ratios of the factors alone, so that few rounds are enough.
  for (int round = 0; round < 8; ++round)
  {
    find_shares();
    for (std::size_t kind = 0; kind < n_bond_kinds; ++kind)
      for (int i = 0; medium.factor[kind] > 0. && i < 20; ++i)
      {
        const double a = medium.share[kind], g = medium.factor[kind];
        const auto weight = [a, g](double factor) { return 1. / (1. + a * (factor / g - 1.)); };
        medium.factor[kind] = mean_over(distribution, [&](double factor) { return factor * weight(factor); }) /
                              mean_over(distribution, weight);
      }
  }
  return medium;
}

ClaimOutcome disorder_claim(const bridge::Subject &subject, const DisorderOptions &options)
{
  ClaimOutcome outcome;
  lattice::Disorder disorder{{}, options.disorder.stiffness, options.disorder.seed};
  if (disorder.stiffness.is_none())
    disorder.stiffness = {lattice::Distribution::Kind::uniform, widest_checked_disorder};
  else if (disorder.stiffness.width() > widest_checked_disorder)
    disorder.stiffness = {disorder.stiffness.kind(), widest_checked_disorder};
  const Rows rows(outcome.results, "disorder", subject.name + ": ");
  rows.attempt("sheets with disorder of the stiffness",
               [&] { DisorderedSheets(subject, options, disorder, rows).run(outcome); });
  return outcome;
}

ClaimOutcome check_disorder(const ClaimInput &input)
{
  DisorderOptions options;
  options.disorder = input.entries.disorder.disorder();
  if (!input.quick)
  {
    options.n_sheets = 64;
    options.columns = 48;
  }
  return disorder_claim(input.subject, options);
}

} // namespace latcon::claims
