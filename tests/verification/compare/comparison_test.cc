#include "verification/compare/comparison.h"

#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "frames.h"
#include "support/errors.h"
#include "tests/support/temporary_folder.h"

namespace comparison_test
{

using namespace latcon;

using namespace compare;
using namespace output;

class Comparing : public testing::Test
{
protected:
  LatticeFrame lattice(std::optional<double> time = {}) const
  {
    return read_lattice_frame(find_frame(folder_ / "a.vtp", Side::lattice, time), time);
  }

  ContinuumFrame continuum(std::optional<double> time = {}) const
  {
    return read_continuum_frame(find_frame(folder_ / "a.vtu", Side::continuum, time), time);
  }

  // Compares as the command does.
  Results run(const std::map<std::string, double> &tolerances = {}) const
  {
    const LatticeFrame here = lattice();
    const ContinuumFrame there = continuum();
    require_same_time(here, there);
    require_same_bounds(here, there);
    return norms(here, there, compare::compare(here, there, {}, MPI_COMM_SELF), tolerances);
  }

  static Result row(const Results &results, const std::string &quantity)
  {
    for (const Result &result : results.rows())
      if (result.quantity == quantity)
        return result;
    ADD_FAILURE() << "no row " << quantity;
    return {};
  }

  // Expects an input error whose message contains all parts.
  template <typename Work>
  static void refused(const Work &work, const std::vector<std::string> &parts)
  {
    try
    {
      work();
      ADD_FAILURE() << "accepted, though to be refused for: " << parts.front();
    }
    catch (const latcon::support::InputError &error)
    {
      for (const std::string &part : parts)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << part << " is not in: " << error.what();
    }
  }

  void refused(const std::vector<std::string> &parts) const
  {
    refused([&] { run(); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(Comparing, FindsNothingBetweenEqualSheets)
{
  write_lattice(folder_ / "a.vtp", {});
  write_continuum(folder_ / "a.vtu", {});
  const Results results = run({{"displacement", 1e-12}});
  EXPECT_EQ(row(results, "sites").lattice, 13. * 9.);
  EXPECT_EQ(row(results, "sites outside the finite element sheet").lattice, 0.);
  EXPECT_EQ(row(results, "free sites inside").lattice, 11. * 7.);
  EXPECT_LT(row(results, "displacement, largest difference").error, 1e-14);
  EXPECT_LT(row(results, "cauchy_stress, rms difference").error, 1e-14);
  EXPECT_EQ(results.verdict(), Verdict::holds);
}

TEST_F(Comparing, MeasuresADifferenceByItsNorms)
{
  MadeUpState state;
  write_continuum(folder_ / "a.vtu", state);
  const auto before = state.displacement;
  state.displacement = [&](double X, double Y)
  {
    auto u = before(X, Y);
    u[0] += 3e-5 * (X > 0.03 ? 1. : 0.); // at 5 of the 11 free columns
    u[1] -= 4e-5 * (X > 0.03 ? 1. : 0.);
    return u;
  };
  state.scale_of_stress = 1.25;
  write_lattice(folder_ / "a.vtp", state);
  const Results results = run({{"displacement", 1e-3}});
  const Result largest = row(results, "displacement, largest difference");
  EXPECT_NEAR(*largest.error * std::max(*largest.lattice, *largest.continuum), 5e-5, 1e-17);
  EXPECT_NEAR(*largest.continuum, std::hypot(0.1 * 0.055 + 0.02 * 0.035, 0.2 * 0.035), 1e-15);
  const Result rms = row(results, "displacement, rms difference");
  EXPECT_NEAR(*rms.error * std::max(*rms.lattice, *rms.continuum), 5e-5 * std::sqrt(5. / 11.), 1e-17);
  EXPECT_EQ(rms.verdict(), Verdict::fails);
  EXPECT_EQ(results.verdict(), Verdict::fails);
  const Result stress = row(results, "first_piola_stress, rms difference");
  EXPECT_NEAR(*stress.lattice, 1.25e5 * std::sqrt(2.), 1e-9);
  EXPECT_NEAR(*stress.error, 0.2, 1e-14); // relative to the larger side
  EXPECT_EQ(stress.verdict(), Verdict::reported);
  EXPECT_NEAR(*row(results, "deformation_gradient less identity, rms difference").lattice, 0.1 * std::sqrt(2.), 1e-14);
}

// Without any tolerance: what is held must be held alike.
TEST_F(Comparing, FindsOtherLoadsAtTheHeldEdges)
{
  const std::string load = "load: displacement of held sites on the edges, largest difference";
  MadeUpState state;
  write_lattice(folder_ / "a.vtp", state);
  const auto before = state.displacement;
  for (const double more : {0., 1e-5, 1e-3})
  {
    state.displacement = [&](double X, double Y)
    {
      auto u = before(X, Y);
      u[1] *= 1. + more;
      return u;
    };
    write_continuum(folder_ / "a.vtu", state);
    const Result row = this->row(run(), load);
    // The largest displacement is at the corner.
    EXPECT_NEAR(row.error.value(), more * 0.2 * 0.04 / std::hypot(0.1 * 0.06 + 0.02 * 0.04, 0.2 * 0.04),
                1e-3 * more + 1e-14);
    EXPECT_EQ(row.verdict(), more > 1e-4 ? Verdict::fails : Verdict::holds);
  }
  // Inside, sheets of other material may differ.
  state.displacement = [&](double X, double Y)
  {
    auto u = before(X, Y);
    u[0] += 0.1 * X * (0.06 - X) * Y * (0.04 - Y) / 0.0024;
    return u;
  };
  write_continuum(folder_ / "a.vtu", state, 4, 3, 2);
  EXPECT_EQ(run().verdict(), Verdict::holds);
}

TEST_F(Comparing, LeavesSitesThatLackBondsOutOfStressAndEnergy)
{
  // A hole in both sheets: the site in its middle is missing, as are bonds of the eight sites around it.
  const auto removed = [](double X, double Y) { return std::hypot(X - 0.03, Y - 0.02) < 1e-6; };
  write_lattice(folder_ / "a.vtp", {}, 12, 8, 0.06, 0.04, removed);
  write_continuum(folder_ / "a.vtu", {});
  const LatticeFrame here = lattice();
  const Comparison comparison = compare::compare(here, continuum(), {}, MPI_COMM_SELF);
  EXPECT_EQ(comparison.compared(here, common_fields.front()).size(), 11u * 7u - 1u);
  EXPECT_EQ(comparison.compared(here, common_fields.back()).size(), 11u * 7u - 9u);
}

TEST_F(Comparing, HasNoRelativeErrorWhereNothingMoves)
{
  MadeUpState state;
  state.displacement = [](double, double) { return std::array<double, 2>{{0., 0.}}; };
  write_lattice(folder_ / "a.vtp", state);
  write_continuum(folder_ / "a.vtu", state);
  EXPECT_EQ(row(run(), "displacement, rms difference").error, 0.);
}

TEST_F(Comparing, RefusesSheetsOfOtherSize)
{
  write_lattice(folder_ / "a.vtp", {});
  write_continuum(folder_ / "a.vtu", {}, 3, 3, 2, rectangle(0.06 * (1. + 3e-6), 0.04));
  refused({"not the same sheet", "a.vtp", "a.vtu", "0 to 0.06 m by 0 to 0.04 m"});
  write_continuum(folder_ / "a.vtu", {}, 3, 3, 2, rectangle(0.06 * (1. + 1e-7), 0.04)); // rounded
  run();
}

TEST_F(Comparing, RefusesMillimetres)
{
  MadeUpState state;
  write_lattice(folder_ / "a.vtp", state);
  state.scale_of_lengths = 1e3;
  write_continuum(folder_ / "a.vtu", state);
  refused({"1000 times as large", "not in metres"});
}

TEST_F(Comparing, RefusesExchangedAxes)
{
  write_lattice(folder_ / "a.vtp", {});
  write_continuum(folder_ / "a.vtu", {}, 3, 3, 2, rectangle(0.04, 0.06));
  refused({"x and y are exchanged"});
}

TEST_F(Comparing, FindsExchangedAxesOfASquare)
{
  MadeUpState state;
  write_lattice(folder_ / "a.vtp", state, 8, 8, 0.04, 0.04);
  state.displacement = [](double X, double Y) { return std::array<double, 2>{{0.2 * X, 0.1 * Y + 0.02 * X}}; };
  write_continuum(folder_ / "a.vtu", state, 3, 2, 2, rectangle(0.04, 0.04));
  EXPECT_GT(row(run(), "displacement, rms difference").error, 0.3);
}

TEST_F(Comparing, RefusesStressInOtherUnits)
{
  MadeUpState state;
  write_lattice(folder_ / "a.vtp", state);
  state.scale_of_stress = 1.02e-6;
  write_continuum(folder_ / "a.vtu", state);
  refused({"first_piola_stress", "different units", "Pa"});
}

TEST_F(Comparing, RefusesAHoleInOneOfThem)
{
  const auto hole = [](double X, double Y) { return std::hypot(X - 0.03, Y - 0.02) < 0.012; };
  write_lattice(folder_ / "a.vtp", {}, 12, 8, 0.06, 0.04, hole);
  write_continuum(folder_ / "a.vtu", {}, 4, 4, 4);
  refused({"not the same sheet", "the lattice has no site within 0.01 m"});
  write_lattice(folder_ / "a.vtp", {}, 48, 32);
  // 3 by 3 cells without the middle cell: a frame.
  write_continuum(
    folder_ / "a.vtu", {}, 4, 1, 4,
    [](double r, double s)
    {
      const std::array<std::array<double, 2>, 5> corner{{{{0., 0.}}, {{1., 0.}}, {{1., 1.}}, {{0., 1.}}, {{0., 0.}}}};
      const auto k = static_cast<std::size_t>(std::min(3., std::floor(4. * s)));
      const double t = 4. * s - static_cast<double>(k);
      std::array<double, 2> X{};
      for (std::size_t i = 0; i < 2; ++i)
      {
        const double outer = (1. - t) * corner[k][i] + t * corner[k + 1][i];
        X[i] = (i == 0 ? 0.06 : 0.04) * (0.5 + (outer - 0.5) * (1. - 0.7 * r));
      }
      return X;
    });
  refused({"not the same sheet", "the continuum has no cell at the site"});
}

TEST_F(Comparing, RefusesOtherTimes)
{
  MadeUpState state;
  state.moves = true;
  state.time = 2e-4;
  write_lattice(folder_ / "a.vtp", state);
  state.time = 2e-4 * (1. + 5e-9);
  write_continuum(folder_ / "a.vtu", state);
  refused({"the times differ", "of the lattice", "of the continuum", "--lattice-time"});
  require_same_time(lattice(2e-4), continuum(state.time)); // the time was given explicitly
  state.time = 2e-4 * (1. + 2e-10);
  write_continuum(folder_ / "a.vtu", state);
  run();
  EXPECT_EQ(row(run(), "velocity, rms difference").lattice, 2.);
  refused([&] { lattice(3e-4); }, {"has the time 2e-04, not 3e-04"});
}

TEST_F(Comparing, RefusesMotionAgainstEquilibrium)
{
  MadeUpState state;
  write_continuum(folder_ / "a.vtu", state);
  state.moves = true;
  write_lattice(folder_ / "a.vtp", state);
  refused({"the lattice is in motion and the continuum in equilibrium"});
  write_continuum(folder_ / "a.vtu", state);
  state.moves = false;
  write_lattice(folder_ / "a.vtp", state);
  refused({"the continuum is in motion and the lattice in equilibrium"});
  state.time = 0.; // at rest: start of a motion or of an equilibrium
  write_lattice(folder_ / "a.vtp", state);
  state.moves = true;
  write_continuum(folder_ / "a.vtu", state);
  run();
}

TEST_F(Comparing, NamesWhatAFileLacks)
{
  write_lattice(folder_ / "a.vtp", {});
  write_continuum(folder_ / "a.vtu", {});
  for (const char *name :
       {"displacement", "deformation_gradient", "first_piola_stress", "cauchy_stress", "strain_energy_density"})
  {
    MadeUpState state;
    state.without = name;
    write_continuum(folder_ / "b.vtu", state);
    write_lattice(folder_ / "b.vtp", state);
    refused([&] { read_continuum_frame(find_frame(folder_ / "b.vtu", Side::continuum, {})); }, {"b.vtu", name});
    refused([&] { read_lattice_frame(find_frame(folder_ / "b.vtp", Side::lattice, {})); }, {"b.vtp", name});
  }
  refused([&] { run({{"velocity", 1e-3}}); }, {"velocity", "a.vtu"});
}

TEST_F(Comparing, RefusesWhatIsNotANumber)
{
  MadeUpState state;
  state.bad = true;
  write_lattice(folder_ / "a.vtp", state);
  write_continuum(folder_ / "a.vtu", state);
  refused([&] { lattice(); }, {"a.vtp", "'first_piola_stress' is not finite at 1 of 117 points"});
  refused([&] { continuum(); }, {"a.vtu", "'first_piola_stress' is not finite at 1 of 96 points"});
}

TEST_F(Comparing, RefusesDamagedFiles)
{
  for (const auto &[name, side] : {std::pair("a.vtp", Side::lattice), std::pair("a.vtu", Side::continuum)})
  {
    write_lattice(folder_ / "a.vtp", {});
    write_continuum(folder_ / "a.vtu", {});
    std::string content = content_of(folder_ / name);
    for (const std::size_t kept : {std::size_t(0), std::size_t(60), content.size() / 4, content.size() - 400})
    {
      std::ofstream(folder_ / name, std::ios::binary) << content.substr(0, kept);
      refused([&, s = side] { s == Side::lattice ? void(lattice()) : void(continuum()); },
              {name, kept > 60 ? "corrupt: " : "not a VTK file"});
    }
  }
}

TEST_F(Comparing, ChoosesTheFrameOfASeries)
{
  MadeUpState state;
  for (const int i : {0, 1, 2})
  {
    state.time = 0.5 * i;
    write_lattice(folder_ / (std::to_string(i) + ".vtp"), state);
  }
  std::ofstream(folder_ / "lattice.pvd") << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\">\n<Collection>\n"
                                            "<DataSet timestep=\"0\" part=\"0\" file=\"0.vtp\"/>\n"
                                            "<DataSet timestep=\"0.5\" part=\"0\" file=\"1.vtp\"/>\n"
                                            "<DataSet timestep=\"1\" part=\"0\" file=\"2.vtp\"/>\n"
                                            "<DataSet timestep=\"2\" part=\"0\" file=\"gone.vtp\"/>\n"
                                            "</Collection>\n</VTKFile>\n";
  EXPECT_EQ(find_frame(folder_ / "lattice.pvd", Side::lattice, 0.5).path.filename(), "1.vtp");
  EXPECT_EQ(find_frame(folder_.path(), Side::lattice, 1. + 1e-10).path.filename(), "2.vtp");
  EXPECT_EQ(find_frame(folder_.path(), Side::lattice, 0.).times.size(), 4u);
  const auto find = [&](const std::string &name, Side side, std::optional<double> time)
  { return [=] { find_frame(folder_ / name, side, time); }; };
  refused(find("lattice.pvd", Side::lattice, 0.7), {"no frame at 0.7", "0, 0.5, 1"});
  refused(find("lattice.pvd", Side::lattice, {}), {"gone.vtp", "does not exist"});
  refused(find("lattice.pvd", Side::continuum, 0.5), {"a lattice frame where a continuum frame is expected"});
  refused(find("0.vtp", Side::continuum, {}), {"a lattice frame where a continuum frame is expected"});
  refused(find("", Side::continuum, {}), {"no continuum.pvd", "give the lattice first"});
  refused(find("none.vtp", Side::lattice, {}), {"none.vtp", "no such file"});
  std::ofstream(folder_ / "lattice.pvd") << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Coll";
  refused(find("lattice.pvd", Side::lattice, {}), {"truncated"});
}

TEST(ListOfTimes, LeavesOutTheMiddle)
{
  EXPECT_EQ(list_of_times({0., 0.5, 1.}), "0, 0.5, 1");
  EXPECT_EQ(list_of_times({0, 1, 2, 3, 4, 5, 6, 7, 8, 9}), "0, 1, 2, 3, ..., 6, 7, 8, 9");
}

} // namespace comparison_test
