// `latcon resolve` and `latcon gate`, for `latcon study` and `latcon batch`, which are Python (python/latcon/study).
#include <cstdio>
#include <iostream>
#include <numeric>

#include <boost/algorithm/hex.hpp>
#include <nlohmann/json.hpp>

#include "support/available_cores.h"
#include "support/machine_memory.h"
#include "verification/bridge/lattice_sheet.h"
#include "verification/claims/claim_inputs.h"
#include "verification/commands/command.h"
#include "verification/input/case_text.h"
#include "verification/input/files.h"
#include "verification/input/units.h"

namespace latcon::commands
{
namespace
{

using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

// Answers requests; keeps the base case alone, so that an edit of its file changes no run.
class Resolver
{
public:
  explicit Resolver(const input::Options &options) : options_(options) {}

  Json answer(const Json &request)
  try
  {
    if (request.contains("base"))
    {
      base_file_ = boost::algorithm::unhex(request["base"].get<std::string>()); // a path may not be UTF-8
      base_ = input::read_input_file(base_file_);
      return nullptr;
    }
    if (request.contains("nearest"))
      return input::nearest_word(request["nearest"], request["known"].get<Words>());
    if (request.contains("numbers"))
    {
      Json numbers = Json::array();
      for (const std::string text : request["numbers"])
      {
        const input::ParsedNumber number = input::read_quantity(text, request["unit"]);
        numbers.push_back({{"value", number.value}, {"wrong", number.wrong}});
      }
      return numbers;
    }
    if (request.contains("memory"))
    {
      // Of runs that each are a process of their own.
      const auto needs = request["memory"].get<std::vector<double>>();
      const double total = std::accumulate(needs.begin(), needs.end(), 0.) +
                           static_cast<double>(needs.size()) * support::resident_memory();
      if (!options_.yes)
        resources::require_memory({total, 0.});
      return {{"text", resources::memory_text({total, 0.})}};
    }
    return resolved(request);
  }
  catch (const support::InputError &error)
  {
    return {{"problems", error.problems()}};
  }

private:
  // A case for all of its seeds; one without seeds is the base case of a study, which need not be a crack.
  Json resolved(const Json &request) const
  {
    input::Case input;
    input::Parameters parameters;
    input.declare(parameters);
    if (base_.problem.empty())
      parameters.read_text(base_.text, base_file_);
    else
      parameters.read_file(base_file_); // throws the same problems
    auto changes = request["changes"].get<Words>();
    const auto seeds = request["seeds"].get<std::vector<std::uint64_t>>(); // any number is allowed
    if (!seeds.empty())
      changes.push_back("Lattice/noise seed=" + std::to_string(seeds.front()));
    parameters.read_overrides(changes);
    input.nonlocal.is_used = request.value("on_continuum", false);
    input.check(parameters);
    if (!seeds.empty())
      bridge::require_fracture_case(input, parameters);
    if (request["checks_laws"])
      claims::check_user_laws(input, parameters);
    parameters.finish();
    if (request["wants_text"])
      return parameters.resolved_text();
    Json reply{{"spacing", input.spacing}};
    Json &values = reply["values"] = Json::object();
    for (const std::string key : request["keys"])
      values[key] = parameters.value(key);
    add_cost(input, reply);
    for (const std::uint64_t seed : seeds)
    {
      input.noise_seed = seed; // cppcheck-suppress unreadVariable ; `parameters` refer to it
      reply["sha256"].push_back(input::sha256(parameters.lines()));
    }
    return reply;
  }

  static void add_cost(const input::Case &input, Json &reply)
  {
    const lattice::TimeStepping stepping = input.fracture_time_stepping();
    const double evaluations = resources::expected_steps(input, stepping) * stepping.evaluations();
    const resources::MemoryNeed memory = resources::lattice_memory(input, resources::RunKind::fracture, true);
    reply.update({{"size", static_cast<double>(input.sheet().n_sites())},
                  {"evaluations", evaluations},
                  {"seconds", resources::core_seconds(input, evaluations)},
                  {"memory", memory.shared + memory.first_rank}});
  }

  const input::Options &options_;
  std::string base_file_;
  input::InputFile base_;
};

} // namespace

support::ExitCode resolve_cases(const input::Options &options)
{
  // Not to std::cout, of which a copy is kept for logs.
  const auto print = [](const Json &line)
  {
    std::puts(line.dump(-1, ' ', false, Json::error_handler_t::replace).c_str());
    std::fflush(stdout);
  };
  Json facts = schema_document(options);
  facts["cores"] = support::available_cores();
  facts["record"] = Json::parse(output::RunInfo(options.arguments).json({}));
  print(facts);
  Resolver resolver(options);
  for (std::string line; std::getline(std::cin, line);)
    print(resolver.answer(Json::parse(line)));
  return support::ExitCode::done;
}

support::ExitCode verify_before_cracks(const input::Options &options)
{
  input::Case input;
  input::Parameters parameters;
  read_case(options, input, parameters);
  parameters.finish();
  Run run(options, nullptr);
  const output::Results results =
    require_verified(input, claims_before_fracture(input.material(), input.nonlocal.is_used),
                     bridge::laws_of_lattice(), run);
  return run.end(results, support::ExitCode::done);
}

} // namespace latcon::commands
