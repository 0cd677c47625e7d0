#pragma once

#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "continuum/lattice_gradient.h"
#include "tests/verification/claims/subjects.h"
#include "verification/output/results.h"

/// Mistakes to plant in a subject, one side of which stays right. A claim that cannot fail claims nothing.
namespace faults
{

/// a times one gradient energy plus b times another.
class Combination : public latcon::continuum::GradientLaw
{
public:
  using Law = std::shared_ptr<const latcon::continuum::GradientLaw>;
  Combination(double a, Law first, double b, Law second)
    : a_(a), b_(b), first_(std::move(first)), second_(std::move(second))
  {
  }
  latcon::continuum::GradientResponse evaluate(const dealii::Tensor<2, 2> &F, const Gradient &G,
                                               latcon::continuum::Order order) const override
  {
    const auto a = first_->evaluate(F, G, order), b = second_->evaluate(F, G, order);
    const auto of = [&, f = factor(F)](const auto &x, const auto &y) { return f * (a_ * x + b_ * y); };
    return {{of(a.energy, b.energy), of(a.first_piola, b.first_piola), of(a.tangent, b.tangent)},
            of(a.double_stress, b.double_stress),
            of(a.double_stress_by_F, b.double_stress_by_F),
            of(a.double_stress_by_G, b.double_stress_by_G)};
  }

protected:
  /// Factor of all of it, for other faults.
  virtual double factor(const dealii::Tensor<2, 2> &) const { return 1.; }

private:
  double a_, b_;
  Law first_, second_;
};

/// The law of a network of fibres with its weights times a factor.
template <class Law>
Law scaled(const latcon::continuum::CauchyBorn &law, double by)
{
  std::vector<latcon::continuum::FibreFamily> families = law.families();
  for (latcon::continuum::FibreFamily &family : families)
    family.weight *= by;
  return Law(std::move(families));
}

/// The gradient energy l_d^2 A - B of the lattice with its k^4 term the wrong way round, l_d^2 A + B.
inline void turn_sign_of_fourth_order(latcon::bridge::Subject &subject)
{
  const latcon::lattice::TriangularLattice sheet = subject.sheet();
  // With twice the square of the length it is 2 l_d^2 A - B, and twice that less three times the right one is wanted.
  const auto longer = std::make_shared<latcon::continuum::LatticeGradient>(
    latcon::bridge::bond_families(sheet, subject.material), std::sqrt(2.) * subject.lengths.lattice);
  subject.lattice_gradient = std::make_shared<Combination>(2., longer, -3., subject.lattice_gradient);
}

/// Rows of an outcome that fail and whose name contains a text; any text: "". There must be judged rows with that text:
/// the test fails where they have other names.
inline std::size_t failing(const latcon::output::Results &results, const std::string &text = "")
{
  std::size_t count = 0, judged = 0;
  for (const latcon::output::Result &row : results.rows())
    if (row.quantity.find(text) != std::string::npos)
    {
      count += row.verdict() == latcon::output::Verdict::fails;
      judged += row.verdict() != latcon::output::Verdict::reported;
    }
  EXPECT_GT(judged, 0u) << "no row is judged whose name contains: " << text;
  return count;
}

/// Returns rest or the state of a case, so that each occurs with one set of shells of expect_holds.
inline Eigen::Matrix2d state_for(const latcon::input::Case &input, const latcon::bridge::Subject &subject)
{
  return subject.material.next_nearest ? Eigen::Matrix2d::Identity() : input.deformation();
}

/// Expects that no row of a claim fails and some hold, with both sets of shells, where rows run across the crack. With
/// rows along the crack, both sets of shells and both states they are those of `latcon verify --quick`
/// (verify_test.py).
/// @param check results of the claim for a case and its subject
inline void expect_holds(
  const std::function<latcon::output::Results(const latcon::input::Case &, const latcon::bridge::Subject &)> &check)
{
  latcon::input::Case input = subjects::paper_case();
  input.orientation = latcon::lattice::Orientation::rows_across_crack;
  for (const latcon::lattice::Material &material : {input.material(), subjects::nearest_only(input)})
  {
    const latcon::output::Results results = check(input, latcon::bridge::subject(input, material));
    EXPECT_TRUE(results.all_hold()) << results.verdict_text(8);
  }
}

} // namespace faults
