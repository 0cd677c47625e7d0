// Damage field and quasi-static fracture of a bar.
#include "continuum/damage/damage_solver.h"

#include <gtest/gtest.h>

#include "continuum/dynamic_solver.h"
#include "continuum/errors.h"
#include "continuum/field_writer.h"
#include "support/largest_error.h"
#include "tests/continuum/sheets.h"

#include <algorithm>
#include <filesystem>
#include <set>

namespace continuum_damage_test
{

using namespace latcon::continuum;
using dealii::Point;
using dealii::Tensor;
using sheets::matrix;
using sheets::Mesh;

constexpr double xi = 1e-3;     // regularisation length [m]
constexpr double critical = 2.; // stretch of the bar at the threshold
const CauchyBorn rubber = sheets::rubber_network();

Tensor<2, 2> stretched(const double stretch)
{
  return matrix(stretch, 0., 0., 1.);
}

DamageLaw law()
{
  return {rubber.energy(stretched(critical)), xi};
}

// Bar of one row of square cells in uniaxial strain.
struct Bar
{
  Bar(const double h, const unsigned int cells, const Constitution &laws, const double last_stretch,
      const DamageSettings &settings = quick())
    : length(cells * h), height(h), last(last_stretch)
  {
    make_rectangle(mesh, {length, h, cells, 1});
    const auto field = sheets::affine(stretched(last));
    const dealii::ComponentMask across(std::vector<bool>{false, true});
    const BoundaryConditions held(
      {{edge::left, field}, {edge::right, field}, {edge::bottom, field, across}, {edge::top, field, across}});
    solver = std::make_unique<DamageSolver>(mesh, laws, held, law(), std::set<dealii::types::boundary_id>{}, settings);
  }
  static DamageSettings quick()
  {
    DamageSettings settings;
    settings.statics.degree = 2;
    return settings;
  }
  void stretch(const double stretch) { solver->step_to((stretch - 1.) / (last - 1.)); }
  // Stress along the bar [Pa].
  double stress() const { return solver->statics().reactions().at(edge::right)[0] / height; }

  Mesh mesh{MPI_COMM_WORLD};
  double length, height, last;
  std::unique_ptr<DamageSolver> solver;
};

// A bar too short for a crack: damage is homogeneous.
Bar short_bar()
{
  return Bar(xi / 4., 2, rubber, 3.);
}

// Damage of the homogeneous bar: g'(d) W = -2 (1 - k) W_c.
double homogeneous_damage(const double stretch)
{
  return std::max(0., 1. - law().threshold / rubber.energy(stretched(stretch)));
}

// Bar with a weak spot in its middle column of cells, loaded until it has broken.
struct BrokenBar : Bar
{
  BrokenBar(const unsigned int cells_per_length, const Constitution &laws, const double last_stretch)
    : Bar(xi / cells_per_length, 8 * cells_per_length + 1, laws, last_stretch)
  {
    const double h = height, middle = 0.5 * length;
    solver->set_damage([=](const Point<2> &X) { return std::abs(X[0] - middle) < 0.6 * h ? 0.02 : 0.; });
    for (const double to : {1.9, 2.1, 7., last})
      stretch(to);
  }
  // S over G_c, and its value for a discrete crack that is open: d is 1 over a whole column of cells, which adds
  // 3/8 h/xi, and linear in each cell beside it, eq. (C.68).
  double energy() const { return solver->field().fracture_energy() / (law().fracture_energy() * height); }
  double expected() const { return 1. + 3. / 8. * height / xi + height * height / (32. * xi * xi); }
  // Amount by which d misses 1: W_c over the energy density of the open column, which has all of the elongation, times
  // 2 + 4 xi/h by eq. (C.63).
  double missing() const
  {
    const double open = 1. + (last - 1.) * length / height;
    return law().threshold / rubber.energy(stretched(open)) * (2. + 4. * xi / height);
  }

  // Columns of nodes and their damage.
  std::vector<double> profile() const
  {
    std::vector<Point<2>> points;
    for (double X = 0.; X < length * (1. + 1e-9); X += height)
      points.emplace_back(std::min(X, length), 0.);
    return solver->field().evaluate(points);
  }
};

// theory-damage.md, eqs. (C.59), (C.60) and (C.62).
TEST(Damage, ScalesEveryTermOfTheEnergy)
{
  Mesh mesh(MPI_COMM_WORLD);
  make_rectangle(mesh, sheets::rectangle(3, 2));
  const LatticeGradient gradient = sheets::rubber_gradient(0.02);
  const DamageLaw constants{1e5, 0.02, 1e-3};
  DamageField field(mesh, constants);
  field.set([](const Point<2> &) { return 0.4; });
  const double g = 1e-3 + (1. - 1e-3) * 0.36;
  const Constitution whole(rubber, gradient);
  Constitution weak = whole;
  weak.factor = &field;
  const Sheet a(mesh, whole, 3), b(mesh, weak, 3);
  const auto u = sheets::nodal(a,
                               [](const Point<2> &X) {
                                 return Tensor<1, 2>({0.5 * X[0] + 3. * X[0] * X[1], 0.8 * X[1] + 2. * X[0] * X[0]});
                               });

  EXPECT_NEAR(b.energy(u) / a.energy(u), g, 1e-13);
  Sheet::Vector r = a.make_owned(), s = a.make_owned(), magnitude = a.make_owned();
  a.residual(u, r, magnitude);
  b.residual(u, s, magnitude);
  const double scale = r.l2_norm();
  s.add(-g, r);
  EXPECT_LT(s.l2_norm(), 1e-13 * scale);
  Sheet::Matrix K, L;
  a.make_matrix(a.conformity_constraints(), K);
  a.make_matrix(a.conformity_constraints(), L);
  a.tangent(u, a.conformity_constraints(), K);
  b.tangent(u, a.conformity_constraints(), L);
  L.add(-g, K);
  EXPECT_LT(L.frobenius_norm(), 1e-13 * K.frobenius_norm());
  // Away from cell boundaries and on them.
  const std::vector<Point<2>> points = {Point<2>(0.03, 0.01), Point<2>(0.05, 0.)};
  const auto states = a.evaluate(u, points), weaker = b.evaluate(u, points);
  for (unsigned int p = 0; p < 2; ++p)
  {
    EXPECT_LT((weaker[p].P - g * states[p].P).norm(), 1e-12 * states[p].P.norm());
    EXPECT_LT((weaker[p].Q - g * states[p].Q).norm(), 1e-12 * states[p].Q.norm());
    EXPECT_NEAR(weaker[p].energy_density / states[p].energy_density, g, 1e-12);
  }
}

// theory-damage.md, eqs. (C.63) and (C.64).
TEST(Damage, IsTheMinimumOfTheEnergyAmongLargerOnes)
{
  // With hanging nodes.
  Mesh mesh(MPI_COMM_WORLD);
  make_rectangle(mesh, sheets::rectangle(6, 4));
  for (const auto &cell : mesh.active_cell_iterators())
    if (cell->is_locally_owned() && cell->center()[0] < 0.05)
      cell->set_refine_flag();
  mesh.execute_coarsening_and_refinement();
  const LatticeGradient gradient = sheets::rubber_gradient(0.02);
  Constitution laws(rubber, gradient);
  DamageField field(mesh, {2e5, 0.02});
  laws.factor = &field;
  const Sheet sheet(mesh, laws, 3);
  const auto u = sheets::nodal(sheet,
                               [](const Point<2> &X) {
                                 return Tensor<1, 2>({0.2 * X[0] + 0.02 * std::sin(40. * X[0]), 12. * X[0] * X[1]});
                               });
  const auto seed = [](const Point<2> &X) { return X[1] > 0.02 ? 0.1 : 0.; };
  field.set(seed);
  EXPECT_GT(field.minimize(sheet, u, 1.), 0.1);
  EXPECT_LT(field.largest(), 1.);
  EXPECT_EQ(field.minimize(sheet, u, 1.), 0.);
  const double least = sheet.energy(u) + field.fracture_energy();
  EXPECT_GE(*std::min_element(field.damage().begin(), field.damage().end()), -1e-14);

  // E is convex in d: on the way to every other damage above the bound it rises.
  const auto at_minimum = [&](const Point<2> &X) { return field.evaluate({X})[0]; };
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> amount(0., 1.);
  for (const double share : {-1., -0.01, 0.01, 1.})
  {
    DamageField other(mesh, {2e5, 0.02});
    std::map<std::pair<double, double>, double> chosen;
    other.set(
      [&](const Point<2> &X)
      {
        const auto [entry, is_new] = chosen.try_emplace({X[0], X[1]}, 0.);
        if (is_new)
        {
          const double d = at_minimum(X);
          entry->second = d + std::abs(share) * amount(generator) * (share > 0. ? 1. - d : std::min(0., seed(X) - d));
        }
        return std::clamp(entry->second, 0., 1.);
      });
    Constitution others(rubber, gradient);
    others.factor = &other;
    EXPECT_GT(Sheet(mesh, others, 3).energy(u) + other.fracture_energy(), least) << share;
  }
}

// theory-damage.md, eqs. (C.61) and (C.66).
TEST(Damage, BeginsAtTheThresholdAndFollowsTheHomogeneousSolution)
{
  Bar bar = short_bar();
  DamageSolver &solver = *bar.solver;
  bar.stretch(critical * (1. - 1e-6));
  EXPECT_EQ(solver.field().largest(), 0.);
  EXPECT_NEAR(bar.stress(), rubber.first_piola_stress(stretched(critical))[0][0], 1e-5 * bar.stress());
  for (const double stretch : {critical * (1. + 1e-6), 2.2, 2.6})
  {
    bar.stretch(stretch);
    const double d = homogeneous_damage(stretch);
    EXPECT_NEAR(solver.field().largest(), d, 1e-11);
    EXPECT_NEAR(bar.stress(), law().degradation(d) * rubber.first_piola_stress(stretched(stretch))[0][0],
                1e-10 * bar.stress());
  }
}

TEST(Damage, StaysWhenTheLoadFalls)
{
  Bar bar = short_bar();
  DamageSolver &solver = *bar.solver;
  bar.stretch(2.5);
  const double d = solver.field().largest();
  const DamageLedger loaded = solver.ledger();
  for (const double stretch : {1.5, 2.4})
  {
    bar.stretch(stretch);
    EXPECT_EQ(solver.field().largest(), d);
    EXPECT_NEAR(bar.stress(), law().degradation(d) * rubber.first_piola_stress(stretched(stretch))[0][0],
                1e-10 * bar.stress());
  }
  EXPECT_EQ(solver.ledger().fracture, loaded.fracture);
  bar.stretch(2.6);
  EXPECT_NEAR(solver.field().largest(), homogeneous_damage(2.6), 1e-11);
}

// theory-damage.md, eq. (C.65).
TEST(Damage, ClosesTheLedgerToSecondOrderInTheLoadStep)
{
  double last = 0.;
  for (const unsigned int steps : {8u, 16u, 32u})
  {
    Bar bar = short_bar();
    DamageSolver &solver = *bar.solver;
    for (unsigned int n = 1; n <= steps; ++n) // with a step that ends at the threshold
      bar.stretch(1. + 2. * n / steps);
    const DamageLedger &ledger = solver.ledger();
    EXPECT_EQ(ledger.gradient, 0.);
    const double d = homogeneous_damage(3.);
    const double area = bar.length * bar.height;
    EXPECT_NEAR(ledger.fracture, 2. * (1. - law().residual_stiffness) * law().threshold * d * area,
                1e-9 * ledger.fracture);
    const double imbalance = ledger.imbalance / ledger.work;
    if (last != 0.)
    {
      EXPECT_NEAR(std::log2(last / imbalance), 2., 0.1); // the next order is the fourth
    }
    last = imbalance;
  }
  EXPECT_LT(std::abs(last), 2e-3);
}

// theory-damage.md, eqs. (C.67) and (C.68).
TEST(Damage, BreaksABarForTheEnergyOfACrack)
{
  std::vector<double> energies;
  for (const unsigned int n : {2u, 4u})
  {
    const BrokenBar bar(n, rubber, 61.);
    // S falls by 3/2 + 3/8 h/xi times what d misses; twice that.
    EXPECT_NEAR(bar.energy(), bar.expected(), 2. * bar.missing() * (1.5 + 0.375 / n));
    EXPECT_LT(bar.missing(), 1e-4);
    energies.push_back(bar.energy());
    const auto d = bar.profile();
    double worst = 0., asymmetry = 0.;
    for (std::size_t i = 0; i < d.size(); ++i)
    {
      const double distance = (std::abs(static_cast<double>(i) - 0.5 * (d.size() - 1)) - 0.5) * bar.height;
      worst =
        latcon::support::largest_of({worst, std::abs(d[i] - std::pow(std::max(0., 1. - distance / (2. * xi)), 2))});
      asymmetry = latcon::support::largest_of({asymmetry, std::abs(d[i] - d[d.size() - 1 - i])});
    }
    EXPECT_LT(worst, 2. * bar.missing() + 1e-6);
    EXPECT_LT(asymmetry, 1e-9);
    EXPECT_LT(bar.solver->field().largest(), 1.);
  }
  EXPECT_NEAR(2. * energies[1] - energies[0], 1., 1. / (64. * 2.)); // twice (h/xi)^2/64 of the coarser mesh, by (C.68)
}

TEST(Damage, BreaksABarWithGradientEnergyForTheSameEnergy)
{
  const IsotropicGradient gradient(5e5, 0.3 * xi);
  // Less open: the residual stiffness of the gradient energy adds 3e-4 at a stretch of 61, with its square.
  const BrokenBar bar(4, Constitution(rubber, gradient), 7.);
  EXPECT_NEAR(bar.energy(), bar.expected(), 2. * bar.missing() * (1.5 + 0.375 / 4.));
  EXPECT_GT(bar.solver->ledger().gradient, 0.);
}

TEST(Damage, KeepsTheLedgerOfTheLastAcceptedStepAfterAFailure)
{
  DamageSettings settings = Bar::quick();
  settings.max_iterations = 1; // enough below the threshold alone
  Bar bar(xi / 4., 2, rubber, 3., settings);
  bar.stretch(1.5);
  const DamageLedger accepted = bar.solver->ledger();
  EXPECT_THROW(bar.solver->step_to(std::nan("")), InvalidInput);
  bar.stretch(1.6); // the state was not touched
  bar.stretch(1.5);
  EXPECT_NEAR(bar.solver->ledger().elastic, accepted.elastic, 1e-10 * accepted.elastic);
  const DamageLedger last = bar.solver->ledger();
  EXPECT_THROW(bar.stretch(2.5), SolverFailed);
  EXPECT_EQ(bar.solver->ledger().work, last.work);
  EXPECT_EQ(bar.solver->ledger().fracture, 0.);
  EXPECT_THROW(bar.stretch(1.5), InvalidInput);
  EXPECT_THROW(bar.solver->set_damage([](const Point<2> &) { return 0.; }), InvalidInput);
  EXPECT_EQ(bar.solver->ledger().work, last.work);
}

// A law whose energy density is shifted below 0.
class NegativeEnergy : public Material
{
public:
  double energy(const Tensor<2, 2> &F) const override { return rubber.energy(F) - 1e9; }
  Tensor<2, 2> first_piola_stress(const Tensor<2, 2> &F) const override { return rubber.first_piola_stress(F); }
  dealii::Tensor<4, 2> tangent(const Tensor<2, 2> &F) const override { return rubber.tangent(F); }
  double thickness_stretch(const Tensor<2, 2> &F) const override { return rubber.thickness_stretch(F); }
};

// Text of the InvalidInput that a function throws.
template <class Function>
std::string refusal(const Function &function)
{
  try
  {
    function();
  }
  catch (const InvalidInput &error)
  {
    return error.what();
  }
  return "";
}

TEST(Damage, RejectsAnEnergyThatHasNoMinimum)
{
  Mesh mesh(MPI_COMM_WORLD);
  make_rectangle(mesh, sheets::rectangle(2, 2));
  const NegativeEnergy negative;
  const Sheet sheet(mesh, negative, 2);
  DamageField field(mesh, law());
  const auto u = sheets::nodal(sheet, [](const Point<2> &) { return Tensor<1, 2>(); });
  EXPECT_THROW(field.minimize(sheet, u, 1.), NonPhysicalState);
}

TEST(Damage, RejectsWhatItDoesNotSupport)
{
  Mesh mesh(MPI_COMM_WORLD);
  make_rectangle(mesh, sheets::rectangle(2, 2));
  const DamageField field(mesh, law());
  const IsotropicGradient gradient(5e5, xi);
  BoundaryConditions held(sheets::on_all_edges(sheets::affine(stretched(2.))));
  held.normal_gradients = {{edge::right, sheets::affine(stretched(1.))}};
  EXPECT_EQ(refusal([&] { DamageSolver(mesh, Constitution(rubber, gradient), held, law()); }),
            "a sheet with damage does not support prescribed normal gradients");
  Constitution factored(rubber);
  factored.factor = &field;
  EXPECT_EQ(refusal([&] { DynamicSolver(mesh, factored, {}, {1000.}, DynamicSettings()); }),
            "a motion does not support a stiffness factor");
  const Sheet sheet(mesh, factored, 2);
  const auto folder = std::filesystem::path(testing::TempDir()) / "frames_with_damage";
  FieldWriter frames(MPI_COMM_WORLD, folder);
  const auto u = sheets::nodal(sheet, [](const Point<2> &) { return Tensor<1, 2>(); });
  EXPECT_EQ(refusal([&] { frames.add_frame(0., sheet, u); }), "frames do not support a stiffness factor");
  std::filesystem::remove_all(folder);
}

TEST(Damage, RejectsBadInput)
{
  Mesh mesh(MPI_COMM_WORLD);
  make_rectangle(mesh, sheets::rectangle(2, 2));
  for (const DamageLaw &bad : {DamageLaw{0., xi}, DamageLaw{1., 0.}, DamageLaw{1., xi, 0.}, DamageLaw{1., xi, 1.}})
    EXPECT_THROW(DamageField(mesh, bad), InvalidInput);
  DamageField field(mesh, {1., xi});
  EXPECT_THROW(field.set([](const Point<2> &) { return 1.1; }), InvalidInput);
  EXPECT_THROW(field.evaluate({Point<2>(1., 1.)}), InvalidInput);
  EXPECT_THROW(field.evaluate({Point<2>(std::nan(""), 0.)}), InvalidInput);
  const BoundaryConditions held(sheets::on_all_edges(sheets::affine(stretched(2.))));
  Constitution factored(rubber);
  factored.factor = &field;
  EXPECT_THROW(DamageSolver(mesh, factored, held, law()), InvalidInput);
  DamageSettings settings;
  for (const double bad : {0., std::nan(""), double(INFINITY)})
  {
    settings.tolerance = bad;
    EXPECT_THROW(DamageSolver(mesh, rubber, held, law(), {}, settings), InvalidInput) << bad;
  }
  StaticSolver statics(mesh, factored, held);
  EXPECT_THROW(statics.refine(mesh, 0.5), InvalidInput);
  DamageSolver solver(mesh, rubber, held, law());
  solver.set_damage([](const Point<2> &) { return 0.1; });
  for (const double load_factor : {0., 0.1})
  {
    solver.step_to(load_factor);
    EXPECT_THROW(solver.set_damage([](const Point<2> &) { return 0.; }), InvalidInput) << load_factor;
  }
}

} // namespace continuum_damage_test
