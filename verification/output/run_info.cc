#include "verification/output/run_info.h"

#include "support/full_precision.h"
#include "support/ranks.h"
#include "verification/input/files.h"
#include "verification/output/output_file.h"

#include <latcon_build_facts.h>
#include <latcon_git_commit.h>

#include <mpi.h>
#include <nlohmann/json.hpp>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <sys/resource.h>
#include <thread>

namespace latcon::output
{

namespace
{

using Json = nlohmann::ordered_json;

std::string mpi_version()
{
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
  int length = 0;
  MPI_Get_library_version(text.data(), &length); // allowed before MPI_Init
  // The rest, if any, is the builder and the date.
  const std::string all(text.data(), static_cast<std::size_t>(std::max(length, 0)));
  return all.substr(0, all.find_first_of(",\n"));
}

std::uint64_t peak_memory() // of this process [bytes]
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024; // Linux reports kibibytes
}

// Returns the number of ranks; 1 if MPI is not initialised.
unsigned int n_ranks()
{
  int running = 0;
  MPI_Initialized(&running);
  return running != 0 ? support::n_ranks() : 1;
}

} // namespace

Json RunInfo::standard_facts(const std::optional<support::ExitCode> exit_code, const std::string &verdict) const
{
  const std::chrono::duration<double> total = std::chrono::steady_clock::now() - start_;
  Json phases = Json::object();
  for (const auto &[name, seconds] : stopwatch_.times())
    phases[name] = seconds;
  return {{"program", "latcon"},
          {"version", program_version()},
          {"git_commit", git_commit()},
          {"program_hash", program_hash()},
          {"compiler", LATCON_COMPILER},
          {"build_type", LATCON_BUILD_TYPE},
          {"flags", LATCON_FLAGS},
          {"lattice_flags", LATCON_LATTICE_FLAGS},
          {"libraries",
           {{"deal.II", LATCON_DEALII_VERSION},
            {"Trilinos", LATCON_TRILINOS_VERSION},
            {"p4est", LATCON_P4EST_VERSION},
            {"VTK", LATCON_VTK_VERSION},
            {"Eigen", LATCON_EIGEN_VERSION},
            {"MPI", mpi_version()}}},
          {"hardware_threads", std::thread::hardware_concurrency()},
          {"threads", n_threads_},
          {"mpi_ranks", n_ranks_},
          {"command_line", command_line_},
          {"wall_time_total_s", total.count()},
          {"wall_time_s", std::move(phases)},
          {"peak_memory_bytes", peak_memory()},
          {"verdict", verdict.empty() ? Json() : Json(verdict)},
          {"exit_code", exit_code ? Json(static_cast<int>(*exit_code)) : Json()}};
}

std::shared_ptr<void> Stopwatch::phase(const std::string &name)
{
  const auto start = std::chrono::steady_clock::now();
  return {this, [this, name, start](void *)
          { add(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()); }};
}

void Stopwatch::add(const std::string &name, const double seconds)
{
  const std::lock_guard lock(mutex_);
  const auto found =
    std::find_if(times_.begin(), times_.end(), [&name](const auto &time) { return time.first == name; });
  if (found == times_.end())
    times_.emplace_back(name, seconds);
  else
    found->second += seconds;
}

std::vector<std::pair<std::string, double>> Stopwatch::times() const
{
  const std::lock_guard lock(mutex_);
  return times_;
}

std::string program_version()
{
  return LATCON_VERSION;
}

std::string git_commit()
{
  return LATCON_GIT_COMMIT;
}

const std::string &program_hash()
{
  static const std::string hash = []
  {
    std::string digits = input::sha256_of_file("/proc/self/exe");
    const std::string module = input::module_file();
    if (digits.empty() || (!module.empty() && input::sha256_of_file(module).empty()))
      throw std::runtime_error("cannot read the executable of this program");
    return module.empty() ? digits : input::sha256(digits + " " + input::sha256_of_file(module));
  }();
  return hash;
}

RunInfo::RunInfo(std::vector<std::string> command_line)
  : command_line_(std::move(command_line)), start_(std::chrono::steady_clock::now()), n_threads_(omp_get_max_threads()),
    n_ranks_(n_ranks()), facts_(std::make_shared<Json>(Json::object()))
{
}

void RunInfo::add(const std::string &key, const Json &value)
{
  if (standard_facts({}, "").contains(key))
    throw std::logic_error("'" + key + "' is a standard key of run.json");
  const std::lock_guard lock(mutex_);
  // JSON has no numbers that are not finite.
  const bool is_number = !value.is_number_float() || std::isfinite(value.get<double>());
  (*facts_)[key] = is_number ? value : Json(support::full_precision(value.get<double>()));
}

std::string RunInfo::json(const std::optional<support::ExitCode> exit_code, const std::string &verdict) const
{
  Json document = standard_facts(exit_code, verdict);
  const std::lock_guard lock(mutex_);
  document.update(*facts_);
  // Arguments and texts may contain bytes that are not UTF-8.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void RunInfo::write(const std::string &path, const std::optional<support::ExitCode> exit_code,
                    const std::string &verdict) const
{
  write_file(path, json(exit_code, verdict));
}

} // namespace latcon::output
