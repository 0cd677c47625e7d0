// Time of a step, per site, beside that of a force evaluation bond by bond; sizes from what fits into the second-level
// cache to what fits into none.
#include <cmath>
#include <iostream>
#include <limits>
#include <vector>

#include <benchmark/benchmark.h>
#include <omp.h>

#include "tests/benchmarks/bond_formulas.h"
#include "tests/benchmarks/sheets.h"
#include "tests/lattice/reference_forces.h"

using namespace latcon;

namespace
{

using benchmarks::Motion;
using benchmarks::Work;

// Calls work(motion) over and over; the argument is the number of sites, about.
template <class Call>
void measure(benchmark::State &run, Work work, const Call &call)
{
  omp_set_num_threads(1);
  Motion motion(work, static_cast<double>(run.range(0)));
  for ([[maybe_unused]] auto _ : run)
    call(motion);
  const auto sites = static_cast<double>(motion.sheet.n_sites());
  run.counters["sites"] = sites;
  run.counters["s/site"] =
    benchmark::Counter(sites, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void reference(benchmark::State &run)
{
  measure(run, Work::everything,
          [](Motion &m) { benchmark::DoNotOptimize(reference_forces(m.simulation.state(), m.sheet, m.bonds)); });
}

void step(benchmark::State &run, Work work)
{
  measure(run, work, [](Motion &m) { m.simulation.step(); });
}

// Root, quotient and law of six bonds per site alone, from and to arrays that fit into the first-level cache, by the
// instruction set of the steps: a lower bound of a step, which also gathers, moves and monitors.
void formulas(benchmark::State &run)
{
  constexpr std::size_t sites = 64, n = 6 * sites;
  const lattice::MooneyRivlinBond law(1e5, 1.5e5);
  const lattice::kernels::BondConstants bond{sheets::spacing, 4e-4, 0.07};
  std::vector<double> dx(n), dy(n), dvx(n), dvy(n), fx(n), fy(n);
  double power = 0.;
  for (std::size_t i = 0; i < n; ++i)
  {
    const double angle = 0.1 * static_cast<double>(i);
    dx[i] = 1.5e-3 * std::cos(angle);
    dy[i] = 1.2e-3 * std::sin(angle);
    dvx[i] = std::sin(3. * angle);
    dvy[i] = std::cos(5. * angle);
    power += lattice::kernels::bond_force(law, bond, 1., dx[i], dy[i], dvx[i], dvy[i]).viscous_power;
  }
  double total = 0.;
  for ([[maybe_unused]] auto _ : run)
  {
    total =
      lattice::kernels::bond_formulas(law, bond, n, dx.data(), dy.data(), dvx.data(), dvy.data(), fx.data(), fy.data());
    benchmark::DoNotOptimize(total);
    benchmark::ClobberMemory();
  }
  bool agrees = std::abs(total - power) <= n * std::numeric_limits<double>::epsilon() * power; // positive terms
  for (std::size_t i = 0; i < n; ++i)
  {
    const auto one = lattice::kernels::bond_force(law, bond, 1., dx[i], dy[i], dvx[i], dvy[i]);
    agrees = agrees && fx[i] == one.x && fy[i] == one.y;
  }
  if (!agrees)
    run.SkipWithError("forces differ from those of single bonds");
  run.counters["sites"] = sites;
  run.counters["s/site"] =
    benchmark::Counter(sites, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// One thread, by its own time, which other work on the machine disturbs less than the clock's.
void one_thread(benchmark::internal::Benchmark *registered)
{
  registered->ArgsProduct({{10'000, 25'000, 100'000, 1'000'000}})->Unit(benchmark::kMillisecond);
}

BENCHMARK(reference)->ArgsProduct({{10'000, 100'000}})->Unit(benchmark::kMillisecond);
BENCHMARK(formulas);
BENCHMARK_CAPTURE(step, everything, Work::everything)->Apply(one_thread);
BENCHMARK_CAPTURE(step, nearest, Work::nearest)->Apply(one_thread);
BENCHMARK_CAPTURE(step, one_branch, Work::one_branch)->Apply(one_thread);
BENCHMARK_CAPTURE(step, three_branches, Work::three_branches)->Apply(one_thread);
BENCHMARK_CAPTURE(step, linear, Work::linear)->Apply(one_thread);

} // namespace

// lattice_kernel --targets               prints the instruction sets that the kernel can be held to here, one a line
// lattice_kernel [--target=NAME] ARGS    ARGS are those of Google Benchmark
int main(int argc, char **argv)
{
  const std::string target = "--target=";
  std::vector<char *> arguments;
  for (int i = 0; i < argc; ++i)
  {
    const std::string argument = argv[i];
    if (argument == "--targets")
    {
      for (const std::string &set : lattice::kernels::instruction_sets())
        std::cout << set << "\n";
      return 0;
    }
    if (argument.rfind(target, 0) != 0)
      arguments.push_back(argv[i]);
    else
      try
      {
        lattice::kernels::use_instruction_set(argument.substr(target.size()));
      }
      catch (const std::invalid_argument &error)
      {
        std::cerr << "lattice_kernel: " << error.what() << "; see --targets\n";
        return 2;
      }
  }
  int n_arguments = static_cast<int>(arguments.size());
  benchmark::AddCustomContext("instruction_set", lattice::kernels::instruction_set());
  benchmark::Initialize(&n_arguments, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(n_arguments, arguments.data()))
    return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
