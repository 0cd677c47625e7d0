// Service of `latcon study` and `latcon batch`, which are Python (python/latcon/study): it resolves cases, verifies them,
// and writes files and records of the study. Each line on standard input, a socket, is a request in JSON; each gets a
// line in reply. An error ends the service as it ends any command.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <map>
#include <numeric>
#include <optional>

#include <nlohmann/json.hpp>
#include <omp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/atomic_file.h"
#include "support/available_cores.h"
#include "support/errors.h"
#include "support/full_precision.h"
#include "support/machine_memory.h"
#include "verification/bridge/lattice_sheet.h"
#include "verification/claims/claim_inputs.h"
#include "verification/commands/claim_registry.h"
#include "verification/commands/command.h"
#include "verification/commands/cost.h"
#include "verification/commands/python.h"
#include "verification/commands/signals.h"
#include "verification/elements/elements.h"
#include "verification/input/case.h"
#include "verification/input/case_text.h"
#include "verification/input/data_folder.h"
#include "verification/input/input_file.h"
#include "verification/input/sha256.h"
#include "verification/input/shipped_cases.h"
#include "verification/input/spelling.h"
#include "verification/input/units.h"
#include "verification/output/crack_quantities.h"
#include "verification/output/output_file.h"
#include "verification/output/progress.h"
#include "verification/output/results.h"
#include "verification/resources/resources.h"

namespace latcon::commands
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr const char *seed_entry = "Lattice/noise seed";

// Lines of the client. The service ends with the client.
class Client
{
public:
  std::string line()
  {
    while (true)
    {
      if (const std::size_t end = pending_.find('\n'); end != std::string::npos)
      {
        const std::string found = pending_.substr(0, end);
        pending_.erase(0, end + 1);
        return found;
      }
      char data[65536];
      const ssize_t n = read(STDIN_FILENO, data, sizeof data);
      if (n <= 0)
        std::_Exit(static_cast<int>(support::ExitCode::interrupted));
      pending_.append(data, static_cast<std::size_t>(n));
    }
  }

  static void send(const Json &reply)
  {
    const std::string text = reply.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    for (std::size_t sent = 0; sent < text.size();)
    {
      const ssize_t n = ::send(STDIN_FILENO, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
      if (n <= 0)
        std::_Exit(static_cast<int>(support::ExitCode::interrupted));
      sent += static_cast<std::size_t>(n);
    }
  }

private:
  std::string pending_;
};

// Exit that the client asks for.
struct Exit : support::Error
{
  using support::Error::Error;
};

std::optional<double> number_of(const std::string &text)
{
  char *end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' && std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

// zeta = (eta / a) / (d / sqrt(a / rho)) of the nearest-neighbour bonds [-]: the retardation time divided by the travel
// time of a wave over one spacing (theory.md, eq. (L.5)). None for linear bonds, which have no a.
std::optional<double> zeta(const input::Case &input)
{
  const input::ShellCase &bond = input.nearest;
  if (bond.law != input::ShellCase::Law::mooney_rivlin || !(bond.a > 0.))
    return {};
  return bond.viscosity / bond.a * std::sqrt(bond.a / input.density) / input.spacing;
}

Json optional_number(const std::optional<double> &value)
{
  if (!value)
    return nullptr;
  return std::isfinite(*value) ? Json(*value) : Json(support::full_precision(*value));
}

std::optional<double> number_in(const Json &value)
{
  if (value.is_null())
    return {};
  return value.is_string() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

class Service
{
public:
  explicit Service(const Json &start)
  {
    options_.arguments = start.at("arguments").get<std::vector<std::string>>();
    options_.output_dir = start.at("output_dir");
    options_.threads = start.at("threads");
    options_.quiet = start.at("quiet");
    options_.verbose = start.at("verbose");
    options_.yes = start.at("yes");
    if (options_.threads > 0)
      omp_set_num_threads(static_cast<int>(options_.threads));
  }

  Json answer(const Json &request)
  {
    const std::string what = request.at("do");
    using Member = Json (Service::*)(const Json &);
    static const std::map<std::string, Member> members{
      {"studies", &Service::studies},
      {"describe", &Service::describe},       {"read", &Service::read},
      {"parse", &Service::parse},             {"printable", &Service::printable},
      {"nearest", &Service::nearest},         {"numbers", &Service::numbers},
      {"base", &Service::base},               {"plan", &Service::plan},
      {"write cases", &Service::write_cases}, {"case text", &Service::case_text},
      {"check base", &Service::check_base},   {"memory", &Service::memory},
      {"lock", &Service::lock},               {"unlock", &Service::unlock},
      {"open", &Service::open},               {"record", &Service::record},
      {"verify", &Service::verify},           {"write", &Service::write},
      {"keep", &Service::keep},               {"in place", &Service::in_place},
      {"print", &Service::print},             {"progress", &Service::progress},
      {"end", &Service::end},                 {"page", &Service::page}};
    const auto found = members.find(what);
    if (found == members.end())
      throw std::logic_error("study service: no request '" + what + "'");
    return (this->*found->second)(request);
  }

private:
  Json describe(const Json &)
  {
    input::Case input;
    input::Parameters parameters;
    input.declare(parameters);
    Json entries = Json::array();
    for (const input::Declaration &entry : parameters.declarations())
    {
      const std::string key = entry.section + "/" + entry.name;
      entries.push_back({{"key", key},
                         {"unit", parameters.unit(key)},
                         {"number_unit", entry.unit.empty() ? "1" : entry.unit},
                         {"is_number", entry.type == input::ValueType::number},
                         {"is_whole", entry.type == input::ValueType::whole_number},
                         {"is_list", entry.type == input::ValueType::numbers}});
    }
    Json sorted = Json::array();
    for (const auto &[key, value] : parameters.values())
      sorted.push_back(key);
    Json quantities = Json::array();
    for (const output::CrackQuantity &quantity : output::crack_quantities())
      quantities.push_back({{"name", quantity.name},
                            {"unit", quantity.unit},
                            {"source", quantity.source == output::CrackQuantity::Source::crack      ? "crack"
                                       : quantity.source == output::CrackQuantity::Source::near_tip ? "near_tip"
                                                                                                    : "derived"}});
    return {{"entries", entries},
            {"sorted", sorted},
            {"quantities", quantities},
            {"cores", support::available_cores()},
            {"version", output::program_version()},
            {"git_commit", output::git_commit()},
            {"program_hash", output::program_hash()}};
  }

  // Files of the shipped studies by name.
  Json studies(const Json &)
  {
    Json files = Json::object();
    for (const std::string &name : shipped_studies())
      files[name] = input::data_folder() + "/studies/" + name + ".json";
    return files;
  }

  Json read(const Json &request)
  {
    const input::InputFile file = input::read_input_file(request.at("file"));
    return {{"text", file.text}, {"problem", file.problem}};
  }

  // Checks that a text is JSON of a study, and returns its document or the error.
  Json parse(const Json &request)
  {
    const std::string name = request.at("file");
    const std::string text =
      request.contains("text") ? request.at("text").get<std::string>() : input::read_input_file(name).text;
    if (const auto problem = input::zero_byte(text, name)) // the parser would stop there
      return {{"error", problem->place + ": " + problem->text}};
    try
    {
      const Json::parser_callback_t limit = [&name](int depth, Json::parse_event_t, Json &)
      {
        constexpr int max_depth = 64; // deeper than any study, and safe for recursion
        if (depth > max_depth)
          throw support::InputError(name + ": not a study: objects and lists are nested deeper than " +
                                    std::to_string(max_depth));
        return true;
      };
      const Json checked = Json::parse(text, limit);
    }
    catch (const support::InputError &error)
    {
      return {{"error", error.what()}};
    }
    catch (const Json::exception &error)
    {
      // "[json.exception.parse_error.101] parse error at line 1, column 2: ...": the words after the bracket.
      const std::string what = error.what();
      return {{"error", name + ": not JSON: " +
                          input::printable(what.substr(std::min(what.size(), what.find(']') + 2)), 200)}};
    }
    return {{"text", text}};
  }

  Json printable(const Json &request)
  {
    const std::string text = request.at("text");
    return request.contains("longest") ? input::printable(text, request.at("longest")) : input::printable(text);
  }

  Json nearest(const Json &request)
  {
    return input::nearest_word(request.at("given"), request.at("known").get<std::vector<std::string>>());
  }

  // Values of texts in SI units.
  Json numbers(const Json &request)
  {
    Json reply = Json::array();
    const std::string unit = request.at("unit");
    for (const Json &text : request.at("texts"))
    {
      const input::ParsedNumber number = input::read_quantity(text.get<std::string>(), unit);
      reply.push_back({{"value", number.value}, {"wrong", number.wrong}});
    }
    return reply;
  }

  // Reads the base case of the study.
  Json base(const Json &request)
  {
    base_name_ = request.at("case");
    case_file_ = input::case_path(base_name_);
    if (request.value("is_shipped_name", false))
      base_name_ = case_file_;
    base_ = input::read_input_file(base_name_);
    return {{"file", base_name_},
            {"text", base_.text},
            {"problem", base_.problem},
            {"hint", base_.problem.empty() ? "" : input::shipped_case_hint(base_name_)}};
  }

  void read_case(const std::vector<std::string> &changes, input::Case &input, input::Parameters &parameters) const
  {
    input.declare(parameters);
    if (base_.problem.empty())
      parameters.read_text(base_.text, base_name_);
    else
      parameters.read_file(base_name_); // throws the same problems
    parameters.read_overrides(changes);
    input.check(parameters);
  }

  void resolve(const Json &request, const Json &seed, bool checks_laws, input::Case &input,
               input::Parameters &parameters) const
  {
    auto changes = request.at("changes").get<std::vector<std::string>>();
    changes.push_back(std::string(seed_entry) + "=" + std::to_string(seed.get<std::uint64_t>()));
    read_case(changes, input, parameters);
    bridge::require_fracture_case(input, parameters);
    if (checks_laws)
      claims::check_user_laws(input, parameters);
    parameters.finish();
  }

  // Size and cost of a run. Adds problems of a case that the finite elements do not support.
  static void add_cost(const input::Case &input, input::Parameters &parameters, bool on_continuum, Json &run)
  {
    resources::MemoryNeed memory;
    double size = 0., evaluations = 0., seconds = 0.;
    if (on_continuum)
    {
      const elements::CrackCost cost = elements::elements().crack_cost(input, parameters);
      size = cost.cells;
      evaluations = cost.evaluations;
      seconds = resources::damage_seconds(size, evaluations);
      memory = resources::damage_memory(size);
    }
    else
    {
      const lattice::TimeStepping stepping = input.fracture_time_stepping();
      size = static_cast<double>(input.lattice().n_sites());
      evaluations = resources::expected_steps(input, stepping) * stepping.evaluations();
      seconds = resources::core_seconds(size * evaluations);
      memory = resources::lattice_memory(input, resources::RunKind::fracture, true);
    }
    run["size"] = size;
    run["evaluations"] = evaluations;
    run["seconds"] = seconds;
    run["memory"] = memory.shared + memory.first_rank;
  }

  // Resolves one case for all of its seeds.
  Json plan_case(const Json &one, bool checks_laws, const std::vector<std::string> &keys) const
  {
    try
    {
      input::Case input;
      input::Parameters parameters;
      resolve(one, one.at("seeds").front(), checks_laws, input, parameters);
      Json run{{"spacing", input.spacing}, {"zeta", optional_number(zeta(input))}};
      run["values"] = Json::object();
      for (const auto &[key, value] : parameters.values())
        if (std::binary_search(keys.begin(), keys.end(), key))
        {
          const std::optional<double> number = number_of(value);
          run["values"][key] = number ? Json(*number) : Json(value);
        }
      add_cost(input, parameters, one.at("on_continuum"), run);
      run["sha256"] = Json::array();
      for (const Json &seed : one.at("seeds"))
      {
        input.noise_seed = seed.get<std::uint64_t>(); // any number is allowed
        run["sha256"].push_back(input::sha256(parameters.lines()));
      }
      return run;
    }
    catch (const support::InputError &error)
    {
      return {{"problems", error.problems()}};
    }
  }

  Json plan(const Json &request)
  {
    auto keys = request.at("keys").get<std::vector<std::string>>();
    std::sort(keys.begin(), keys.end());
    Json reply = Json::array();
    for (const Json &one : request.at("cases"))
      reply.push_back(plan_case(one, request.at("checks_laws"), keys));
    return reply;
  }

  std::string resolved_text(const Json &one) const
  {
    input::Case input;
    input::Parameters parameters;
    resolve(one, one.at("seed"), false, input, parameters); // checked when it was planned
    return parameters.resolved_text();
  }

  Json case_text(const Json &request) { return resolved_text(request); }

  Json write_cases(const Json &request)
  {
    for (const Json &one : request.at("cases"))
      output::write_file(one.at("file"), resolved_text(one));
    return nullptr;
  }

  input::Case base_case(const Json &request) const
  {
    input::Case input;
    input::Parameters parameters;
    read_case(request.at("changes").get<std::vector<std::string>>(), input, parameters);
    claims::check_user_laws(input, parameters);
    parameters.finish();
    return input;
  }

  Json check_base(const Json &request)
  {
    (void)base_case(request);
    return nullptr;
  }

  // Memory of the largest runs that can run concurrently, each in its own process.
  Json memory(const Json &request)
  {
    auto needs = request.at("needs").get<std::vector<double>>();
    for (double &need : needs)
      need += support::resident_memory();
    const resources::MemoryNeed all{std::accumulate(needs.begin(), needs.end(), 0.), 0.};
    if (request.at("prints"))
      std::cout << resources::memory_text(all);
    require_memory(options_, all);
    return nullptr;
  }

  Json lock(const Json &request)
  {
    lock_ =
      lock_directory(request.at("directory"), std::chrono::milliseconds(request.at("milliseconds").get<std::int64_t>()));
    return nullptr;
  }

  Json unlock(const Json &)
  {
    lock_.reset();
    return nullptr;
  }

  Json open(const Json &request)
  {
    options_.output_dir = request.at("output_dir");
    options_.resume = request.at("resume");
    run_.emplace(options_);
    return nullptr;
  }

  Json record(const Json &request)
  {
    const std::string key = request.at("key");
    const Json &value = request.at("value");
    if (request.contains("seconds"))
      run_->info().stopwatch().add(key, value);
    else if (value.is_boolean())
      run_->info().add(key, value.get<bool>());
    else
      run_->info().add(key, value.get<std::string>());
    return nullptr;
  }

  Json verify(const Json &request)
  {
    const input::Case base = base_case(request);
    const bool on_continuum = request.at("on_continuum");
    (void)require_verified(
      base, on_continuum ? claims_before_continuum_fracture(base.material()) : claims_before_fracture(base.material()),
      on_continuum ? bridge::laws_of(base) : bridge::laws_of_lattice(), *run_);
    return nullptr;
  }

  Json write(const Json &request)
  {
    output::write_file(request.at("file"), request.at("text"));
    return nullptr;
  }

  // Writes a file that later runs do not archive.
  Json keep(const Json &request)
  {
    support::write_atomically(request.at("file").get<std::string>(), request.at("text").get<std::string>(),
                              support::Sync::yes);
    return nullptr;
  }

  Json in_place(const Json &request)
  {
    support::require_in_place(request.at("file").get<std::string>());
    return nullptr;
  }

  Json print(const Json &request)
  {
    std::cout << request.at("text").get<std::string>() << std::flush;
    return nullptr;
  }

  // Updates the progress line, or removes it.
  Json progress(const Json &request)
  {
    if (!request.contains("text"))
    {
      line_.reset();
      return nullptr;
    }
    if (!line_)
      line_.emplace(true);
    if (line_->due())
      line_->show(request.at("text"), request.at("done"));
    return nullptr;
  }

  // Writes the rows, and the record with the exit code. @return whether a row fails
  Json end(const Json &request)
  {
    output::Results results;
    for (const Json &row : request.at("rows"))
    {
      output::Result result;
      result.claim = row.at("claim");
      result.quantity = row.at("quantity");
      result.unit = row.at("unit");
      result.lattice = number_in(row.at("lattice"));
      result.theory = number_in(row.at("theory"));
      result.error = number_in(row.at("error"));
      if (const std::optional<double> tolerance = number_in(row.at("tolerance")))
        result.tolerance = {tolerance, row.at("reason")};
      results.add(std::move(result));
    }
    support::ExitCode exit_code{request.at("exit_code").get<int>()};
    if (exit_code == support::ExitCode::done && results.verdict() == output::Verdict::fails)
      exit_code = support::ExitCode::claim_failed;
    return static_cast<int>(run_->end(results, exit_code));
  }

  Json page(const Json &request) { return draw_page(study_page, request.at("directory")); }

  input::Options options_;
  std::string base_name_, case_file_;
  input::InputFile base_;
  std::unique_ptr<support::FolderLock> lock_;
  std::optional<Run> run_;
  std::optional<output::Progress> line_;
};

} // namespace

support::ExitCode serve_study()
{
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  Client client;
  Service service(Json::parse(client.line()));
  while (true)
  {
    const Json request = Json::parse(client.line());
    if (request.at("do") == "exit")
    {
      const support::ExitCode code{request.at("code").get<int>()};
      if (request.contains("message"))
        throw Exit(code, request.at("message"));
      return code;
    }
    Client::send(service.answer(request));
  }
}

} // namespace latcon::commands
