// Time of a step, per site, beside that of a force evaluation bond by bond; sizes from what fits into the second-level
// cache to what fits into none.
#include <iostream>

#include <benchmark/benchmark.h>
#include <omp.h>

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

// One thread, by its own time, which other work on the machine disturbs less than the clock's.
void one_thread(benchmark::internal::Benchmark *registered)
{
  registered->ArgsProduct({{10'000, 25'000, 100'000, 1'000'000}})->Unit(benchmark::kMillisecond);
}

BENCHMARK(reference)->ArgsProduct({{10'000, 100'000}})->Unit(benchmark::kMillisecond);
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
