// Time of a force evaluation and of a step, per site, beside that of the reference evaluation; sizes from what fits
// into the second-level cache to what fits into none.
#include <benchmark/benchmark.h>
#include <omp.h>

#include "lattice/runge_kutta_chebyshev.h"
#include "lattice/velocity_verlet.h"
#include "tests/lattice/reference_forces.h"
#include "tests/lattice/sheets.h"

namespace
{

using namespace lattice;

struct Sheet
{
  explicit Sheet(double sites)
    : sheet(sheets::square(std::sqrt(sites))), material(sheets::rubber()),
      state(homogeneous_state(sheet, material, sheets::stretched(2.3, 2.8), Edges::held, sheets::unbreakable)),
      forces(sheet, material), verlet(sheet, forces, 1e-8), chebyshev(sheet, forces, 1e-8, stages)
  {
    add_noise(state, sheet, 0.01 * sheets::spacing, 1);
    verlet.initialise(state);
    chebyshev.initialise(state);
  }
  static constexpr unsigned int stages = 6;
  TriangularLattice sheet;
  Material material;
  State state;
  Forces forces;
  VelocityVerlet verlet;
  RungeKuttaChebyshev chebyshev;
};

// Calls work(sheet) over and over; arguments are the number of sites, about, and of threads.
template <class Work>
void measure(benchmark::State &run, const Work &work)
{
  omp_set_num_threads(static_cast<int>(run.range(1)));
  Sheet sheet(static_cast<double>(run.range(0)));
  for ([[maybe_unused]] auto _ : run)
    work(sheet);
  const auto sites = static_cast<double>(sheet.sheet.n_sites());
  run.counters["sites"] = sites;
  run.counters["s/site"] =
    benchmark::Counter(sites, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void reference(benchmark::State &run)
{
  measure(run, [](Sheet &s) { benchmark::DoNotOptimize(reference_forces(s.state, s.sheet, s.material)); });
}

void evaluation(benchmark::State &run)
{
  measure(run, [](Sheet &s) { s.forces.evaluate(s.state, s.state.vx, s.state.vy); });
}

void step(benchmark::State &run)
{
  measure(run, [](Sheet &s) { s.verlet.step(s.state); });
}

// A sixth of it is what an evaluation costs with the stage it is for.
void chebyshev_step(benchmark::State &run)
{
  measure(run, [](Sheet &s) { s.chebyshev.step(s.state); });
}

// One thread by its own time, which other work on the machine disturbs less; several by the clock.
const std::vector<std::int64_t> sizes{10'000, 45'000, 200'000, 1'000'000};

BENCHMARK(reference)->ArgsProduct({sizes, {1}})->Unit(benchmark::kMillisecond);
BENCHMARK(evaluation)->ArgsProduct({sizes, {1}})->Unit(benchmark::kMillisecond);
BENCHMARK(step)->ArgsProduct({sizes, {1}})->Unit(benchmark::kMillisecond);
BENCHMARK(chebyshev_step)->ArgsProduct({sizes, {1}})->Unit(benchmark::kMillisecond);
BENCHMARK(step)->ArgsProduct({sizes, {2, 4}})->UseRealTime()->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
