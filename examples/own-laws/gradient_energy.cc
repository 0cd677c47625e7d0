// Experiment: a layer of rubber with stiff fibres across it, glued between two plates and sheared.
//
// The fibres resist bending: a gradient energy, A. J. M. Spencer, K. P. Soldatos, Int. J. Non-Linear Mech. 42, 355
// (2007). They leave the plates at a right angle, so that the layer cannot shear next to these, and is stiffer than
// without them. The shear stress is measured on two meshes and set beside the closed form of the layer. Exit code 1 if
// they disagree.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <deal.II/base/function.h>
#include <deal.II/base/symmetric_tensor.h>

#include "continuum/gradient_law.h"
#include "continuum/meshes.h"
#include "continuum/mooney_rivlin.h"
#include "continuum/parallel_session.h"
#include "continuum/static_solver.h"

using namespace latcon;

namespace
{

using dealii::Tensor;

/// Fibres along the unit vector a of the reference configuration, with the curvature k_i = G_iJK a_J a_K:
///   W_g = (c / 2) |k|^2,   so   Q_iJK = dW_g/dG_iJK = c k_i a_J a_K
/// Gradient energy that does not depend on F.
class BendingFibres : public continuum::GradientLaw
{
public:
  /// c [Pa m^2] >= 0: bending stiffness of the fibres that cross a unit of area.
  BendingFibres(double stiffness, const Tensor<1, 2> &direction)
    : c_(stiffness), a_(direction / direction.norm()), aa_(outer_product(a_, a_))
  {
  }

  continuum::GradientResponse evaluate(const Tensor<2, 2> &, const Gradient &G, continuum::Order order) const override
  {
    continuum::GradientResponse W;
    W.energy = 0.5 * c_ * curvature(G).norm_square();
    if (order == continuum::Order::value)
      return W;
    W.double_stress = c_ * outer_product(curvature(G), aa_);
    for (unsigned int i = 0; i < 2 && order == continuum::Order::second; ++i)
      for (unsigned int J = 0; J < 2; ++J)
        for (unsigned int K = 0; K < 2; ++K)
          W.double_stress_by_G[i][J][K][i] = c_ * aa_[J][K] * aa_; // c delta_il a_J a_K a_M a_N
    return W;
  }

private:
  Tensor<1, 2> curvature(const Gradient &G) const
  {
    return Tensor<1, 2>({scalar_product(G[0], aa_), scalar_product(G[1], aa_)});
  }

  double c_;
  Tensor<1, 2> a_;
  Tensor<2, 2> aa_;
};

/// Checks that the functions of a law that does not depend on F belong together: Q : G = 2 W_g and C : G = Q, for a
/// gradient that is symmetric in its last two indices. Newton's method forgives a wrong C, and only takes longer.
bool is_consistent(const continuum::GradientLaw &law)
{
  const Tensor<2, 2> F(dealii::unit_symmetric_tensor<2>());
  continuum::GradientLaw::Gradient G;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      for (unsigned int K = 0; K < 2; ++K)
        G[i][J][K] = 1. + 2. * i + 5. * (J + K);
  const continuum::GradientResponse W = law.evaluate(F, G, continuum::Order::second);
  const double of_energy = std::abs(scalar_product(W.double_stress, G) - 2. * W.energy);
  double of_stress = 0.;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int J = 0; J < 2; ++J)
      for (unsigned int K = 0; K < 2; ++K)
        of_stress =
          std::max(of_stress, std::abs(scalar_product(W.double_stress_by_G[i][J][K], G) - W.double_stress[i][J][K]));
  return of_energy <= 1e-13 * W.energy && of_stress <= 1e-13 * W.double_stress.norm();
}

/// A layer of height H [m] between plates that move by shear * H against each other.
struct Layer
{
  double height, shear;
  const continuum::Material &rubber;
  const continuum::GradientLaw &fibres;

  /// Force on the upper plate over its area [Pa], for a layer with this number of cells across.
  double shear_stress(unsigned int cells) const
  {
    const auto constant = [](double x) {
      return std::make_shared<dealii::Functions::ConstantFunction<2>>(std::vector<double>{x, 0.});
    };
    const double length = height / 2.;
    continuum::Sheet::Mesh mesh(MPI_COMM_SELF);
    continuum::make_rectangle(mesh, {length, height, 2, cells, true});
    continuum::BoundaryConditions conditions{{continuum::edge::bottom, constant(-0.5 * shear * height)},
                                             {continuum::edge::top, constant(0.5 * shear * height)}};
    conditions.normal_gradients = {{continuum::edge::bottom, constant(0.)}, {continuum::edge::top, constant(0.)}};
    conditions.periodic = {{continuum::edge::left, continuum::edge::right, 0}};
    continuum::StaticSolver solver(mesh, continuum::Constitution(rubber, fibres), conditions);
    solver.solve();
    return solver.reactions().at(continuum::edge::top)[0] / length;
  }
};

} // namespace

int main()
{
  const continuum::ParallelSession session;

  // With C2 = 0 simple shear leaves the thickness alone, and the local law is linear in it (theory-continuum.md, eq.
  // (C.35)).
  const double mu = 0.25e6, length = 4e-3;
  const continuum::MooneyRivlin rubber(continuum::MooneyRivlin::Constants::with_equal_lame_constants(mu, 0.));
  const BendingFibres fibres(mu * length * length, Tensor<1, 2>({0., 1.}));
  const Layer layer{20e-3, 1., rubber, fibres};

  const double share = 2. * length / layer.height * std::tanh(layer.height / (2. * length));
  const double theory = mu * layer.shear / (1. - share);
  const double coarse = layer.shear_stress(8), fine = layer.shear_stress(16);

  // The change when the cells are halved exceeds the remaining error.
  const double error = std::abs(fine - theory), tolerance = std::abs(fine - coarse);
  std::printf("Rubber with bending fibres, sheared by %.0f%% of its height\n", 100. * layer.shear);
  std::printf("  shear stress without fibres  %10.3f Pa\n", mu * layer.shear);
  std::printf("  closed form with fibres      %10.3f Pa\n", theory);
  std::printf("  finite elements,  8 cells    %10.3f Pa\n", coarse);
  std::printf("                   16 cells    %10.3f Pa, off by %.1e of %.1e Pa\n", fine, error, tolerance);
  const bool consistent = is_consistent(fibres);
  std::printf("  the law's functions %s\n", consistent ? "belong together" : "do NOT belong together");
  const bool good = consistent && error <= tolerance && tolerance < 1e-3 * theory;
  std::puts(good ? "they agree" : "they do NOT agree");
  return good ? 0 : 1;
}
