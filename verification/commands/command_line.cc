#include "verification/commands/command_line.h"

#include <algorithm>
#include <filesystem>
#include <iostream>

#include <omp.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "lattice/row_kernels.h"
#include "support/available_cores.h"
#include "support/ranks.h"
#include "verification/commands/command.h"
#include "verification/commands/recorded_output.h"
#include "verification/elements/elements.h"
#include "verification/input/case_text.h"
#include "verification/input/files.h"

namespace latcon::commands
{
namespace
{

using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

constexpr unsigned int max_threads = 4096;

// Sets the threads of each rank; by default OMP_NUM_THREADS, or as many as there are cores for it. Throws for an
// environment variable that asks for too many, or names no instruction set of the lattice.
void set_up_threads(const input::Options &options)
{
  const unsigned int available = support::available_cores_per_rank(); // on all ranks, whatever their variables
  if (const unsigned int threads = has_default_threads(options) ? available : options.threads; threads > 0)
    omp_set_num_threads(static_cast<int>(threads));
  else if (omp_get_max_threads() > static_cast<int>(max_threads))
    throw support::InputError("OMP_NUM_THREADS is " + std::to_string(omp_get_max_threads()) + "; allowed: 1 to " +
                              std::to_string(max_threads));
  try
  {
    lattice::kernels::instruction_sets();
  }
  catch (const std::invalid_argument &error)
  {
    throw support::InputError(error.what());
  }
}

constexpr const char *exit_codes =
  "Exit codes: 0 done, every claim holds; 1 internal error; 2 bad input; 3 a claim does not hold;\n"
  "4 a solver did not converge or the state blew up; 5 a file could not be written; 130 interrupted.";

constexpr const char *shared_options =
  "Also, with every command (described by latcon --help): --set, --output-dir, --threads, --quiet,\n"
  "--no-report, --verbose, --resume, --dry-run, --yes.\n";

// Adds an option or a flag of a command that is Python, which gets its value under a key. @param type of it in the help
template <class Value>
CLI::Option *keep(CLI::App *command, Json &chosen, const std::string &key, const std::string &name,
                  const std::string &type, const Value &otherwise, const std::string &help)
{
  chosen[key] = otherwise;
  // Python takes empty texts for options that are not given.
  const auto is_given = [](const std::string &text) { return text.empty() ? "the value is empty" : std::string(); };
  return command
    ->add_option_function<Value>(
      name, [&chosen, key](const Value &value) { chosen[key] = value; }, help)
    ->check(is_given)
    ->allow_extra_args(false)
    ->type_name(type);
}
void keep(CLI::App *command, Json &chosen, const std::string &key, const std::string &name, const std::string &help)
{
  chosen[key] = false;
  command->add_flag_callback(
    name, [&chosen, key] { chosen[key] = true; }, help);
}

// Adds an argument that is given without the name of an option; the help states no type of it.
template <class Value>
CLI::Option *add_word(CLI::App *command, const std::string &name, Value &value, const std::string &help)
{
  return command->add_option(name, value, help)->type_name("");
}

support::ExitCode print_help(const CLI::App &app, const input::Options &options, const std::string &topic)
{
  const std::vector<std::string> names = command_names(app);
  const bool is_command = std::find(names.begin(), names.end(), topic) != names.end();
  if (!topic.empty() && !is_command)
    return continue_in_python(options, "help", {topic}, {{"commands", names}});
  if (support::is_root_rank())
    // App::help() of a program whose command line named a command describes that command.
    std::cout << (is_command ? app.get_subcommand(topic)->help(app.get_name())
                             : app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal));
  return support::ExitCode::done;
}

} // namespace

support::ExitCode run_program(int argc, char **argv)
{
  const RecordedOutput recorded;
  input::Options options;
  options.arguments.assign(argv, argv + argc);
  std::function<support::ExitCode()> command;

  CLI::App app("latcon: dynamic fracture of rubber on a triangular lattice, and the continuum it approximates",
               "latcon");
  app.set_version_flag("--version", "latcon " + output::program_version() + " (" + output::git_commit() + ")");
  app.require_subcommand(1);
  // No shell replaces the ~ of `--output-dir=~/run`, and who deletes a folder `~` may lose the home.
  const auto no_tilde = CLI::Validator(
    [](const std::string &folder)
    {
      if (folder.empty())
        return std::string("an empty name is that of no folder");
      return folder == "~" || folder.compare(0, 2, "~/") == 0
               ? "the folder '" + folder + "' begins with ~, which is the home in a shell only; give its path"
               : std::string();
    },
    "");
  app.fallthrough();
  app.footer(exit_codes);
  app.add_option("--set", options.overrides, "Section/Name=value, replaces an entry of the case; repeatable")
    ->allow_extra_args(false)
    ->type_name("ENTRY");
  app
    .add_option("-o,--output-dir", options.output_dir, "output directory; default: output/CASE, or as the command says")
    ->check(no_tilde)
    ->type_name("DIR");
  app
    .add_option("--threads", options.threads,
                "threads of the lattice on each rank; default: OMP_NUM_THREADS, or the cores of a rank")
    ->check(CLI::Range(1u, max_threads))
    ->type_name("N");
  app.add_flag("--quiet", options.quiet, "print errors only");
  app.add_flag("--no-report", options.no_report, "of cracks, studies and comparisons: draw neither pictures nor page");
  app.add_flag("--verbose", options.verbose, "print every row that was checked before and during a crack");
  app.add_flag("--resume", options.resume, "continue from the last checkpoint, or keep the finished runs of a study");
  app.add_flag("--dry-run", options.dry_run, "check the input, print the resolved case and its cost, run nothing");
  app.add_flag("--yes", options.yes, "run also what would take more than 10 days or the memory of the machine");

  const auto add_command = [&](const std::string &name, const std::string &help, const std::string &example,
                               const std::function<support::ExitCode()> &run)
  {
    CLI::App *subcommand = app.add_subcommand(name, help);
    subcommand->footer(std::string(shared_options) + "Example: " + example + "\n\n" + exit_codes);
    subcommand->callback([&command, run] { command = run; });
    return subcommand;
  };
  const auto is_given = [&app](const std::string &name, const std::string &option)
  { return app.get_subcommand(name)->count(option) > 0; };
  const auto default_folder = [&options](const std::string &name)
  {
    if (options.output_dir.empty())
      options.output_dir = "output/" + name;
  };

  options.case_file = input::shipped_case_file("fig1");
  std::string laws;
  CLI::App *verify_command = add_command("verify", "check that lattice and continuum agree, claim by claim",
                                         "latcon verify energy --quick --output-dir output/energy",
                                         [&]
                                         {
                                           options.laws_of_case =
                                             laws.empty() ? is_given("verify", "--case") : laws == "case";
                                           default_folder("verify");
                                           return verify(options);
                                         });
  add_word(verify_command, "CLAIM", options.claims, "claims to check; default: all but those marked (only if named)")
    ->check(CLI::Validator([](const std::string &name) { return unknown_claim(name); }, claim_choices()));
  verify_command
    ->add_option("--case", options.case_file,
                 "case whose material, loading and laws to verify; default: the rubber of Fig. 1")
    ->type_name("FILE");
  verify_command
    ->add_option("--laws", laws,
                 "which laws of the continuum are judged, all or those on which the case relies; others are reported; "
                 "default: case with --case, otherwise all")
    ->check(CLI::IsMember({"all", "case"}))
    ->type_name("LAWS");
  verify_command->add_flag("--quick", options.quick, "small versions");
  verify_command->footer(claim_list() + verify_command->get_footer());

  const auto add_case_command = [&](const std::string &name, const std::string &help, const std::string &example,
                                    const std::string &suffix, support::ExitCode (*run)(const input::Options &))
  {
    CLI::App *subcommand = add_command(name, help, example,
                                       [&options, default_folder, suffix, run]
                                       {
                                         default_folder(std::filesystem::path(options.case_file).stem().string() +
                                                        suffix + (options.on_continuum ? "-continuum-crack" : ""));
                                         return run(options);
                                       });
    add_word(subcommand, "CASE", options.case_file,
             "case file, .prm or .json, or a shipped case: " + input::comma_separated(input::shipped_cases()))
      ->required();
    return subcommand;
  };
  add_case_command("lattice", "equilibrium or motion of the unbroken lattice sheet", "latcon lattice hole", "-lattice",
                   run_lattice);
  add_case_command("continuum", "equilibrium or motion of the finite element sheet", "latcon continuum hole",
                   "-continuum",
                   [](const input::Options &chosen) { return elements::elements().run_continuum(chosen); });
  CLI::App *fracture_command =
    add_case_command("fracture", "verify the case's material and pre-stretch, then run its crack",
                     "latcon fracture quick --set \"Loading/strain y=1.7\"", "", run_fracture);
  fracture_command->add_flag("--skip-verification", options.skip_verification,
                             "run the crack unverified; noted in every output");
  CLI::App *gate_command = add_case_command("gate", "check the claims that wait before a crack, run none",
                                            "latcon gate quick", "-gate", verify_before_cracks);
  for (CLI::App *of_crack : {fracture_command, gate_command})
    of_crack
      ->add_option_function<std::string>(
        "--side", [&options](const std::string &side) { options.on_continuum = side == "continuum"; },
        "which side breaks, the lattice or the nonlocal continuum; default: lattice")
      ->check(CLI::IsMember({"lattice", "continuum"}))
      ->type_name("SIDE");
  CLI::App *resolve_command = add_command("resolve", "cases as JSON, for programs", "latcon resolve <questions.jsonl",
                                          [&] { return resolve_cases(options); });
  for (CLI::App *internal : {gate_command, resolve_command})
    internal->group(""); // not listed: `latcon study` uses them

  std::string study; // file, name of a shipped study, or case of a sweep
  Json study_chosen, batch_chosen, compared;
  const auto add_study_command =
    [&](const std::string &name, const std::string &help, const std::string &example, Json &chosen)
  {
    CLI::App *subcommand =
      add_command(name, help, example, [&, name] { return continue_in_python(options, name, {study}, chosen); });
    add_word(subcommand, "STUDY", study,
             "study file (.json), or a shipped one: " + input::comma_separated(input::shipped_studies()) +
               "; with --sweep a case")
      ->required();
    keep(subcommand, chosen, "sweeps", "--sweep", "ENTRY", Words(),
         "Section/Name=START:STOP:COUNT or =VALUE,VALUE,...: run the case STUDY for these values; repeatable: "
         "all combinations");
    keep(subcommand, chosen, "seeds", "--seeds", "N", 0u, "seeds 1 to N of each case of a sweep; default: 1")
      ->check(CLI::Range(1u, 100000u));
    subcommand->add_flag("--quick", options.quick, "small version");
    subcommand->add_flag("--skip-verification", options.skip_verification,
                         "run the cracks unverified; noted in every output");
    return subcommand;
  };
  CLI::App *study_command = add_study_command("study", "a sweep of cracks, compared with what a source states",
                                              "latcon study paper --quick", study_chosen);
  keep(study_command, study_chosen, "shard", "--shard", "I/N", std::string(),
       "run one of N shares of the runs, without verdict; then --collect");
  keep(study_command, study_chosen, "collect", "--collect", "run nothing: judge the runs of all shards");

  CLI::App *batch_command = add_study_command("batch", "a study as a job array of a cluster",
                                              "latcon batch paper --slurm --tasks 50", batch_chosen);
  batch_command->add_flag("--slurm", "write job scripts for Slurm")->required(); // the only system supported
  keep(batch_command, batch_chosen, "submit", "--submit", "submit them with sbatch");
  keep(batch_command, batch_chosen, "tasks", "--tasks", "N", 0u,
       "tasks of the array; default: one per run, at most 1000")
    ->check(CLI::Range(1u, 100000u));
  keep(batch_command, batch_chosen, "cpus_per_task", "--cpus-per-task", "N", 1u, "runs at once in each task")
    ->check(CLI::Range(1u, max_threads))
    ->default_str("1");
  keep(batch_command, batch_chosen, "time", "--time", "TIME", std::string("1-00:00:00"),
       "limit per task, [days-]hours:minutes:seconds, or MINUTES, MINUTES:SECONDS or DAYS-HOURS as Slurm has them")
    ->default_str("1-00:00:00");
  keep(batch_command, batch_chosen, "partition", "--partition", "NAME", std::string(),
       "partition; default: that of the cluster");

  std::string first, second;
  CLI::App *compare_command =
    add_command("compare", "two cracks, or a lattice frame and a continuum frame site by site",
                "latcon compare output/strip output/thin",
                [&]
                {
                  default_folder("compare");
                  return continue_in_python(options, "compare", {first, second}, compared);
                });
  add_word(compare_command, "LATTICE", first,
           "output directory of a crack; or frame (.vtp), series (.pvd) or output directory of a lattice")
    ->required();
  add_word(compare_command, "CONTINUUM", second,
           "output directory of a second crack; or frame (.vtu, .pvtu), series (.pvd) or output directory of a "
           "continuum")
    ->required();
  keep(compare_command, compared, "time", "--time", "TIME", std::string(),
       "time of both frames, or load factor; default: the last");
  keep(compare_command, compared, "lattice_time", "--lattice-time", "TIME", std::string(), "time of the lattice frame");
  keep(compare_command, compared, "continuum_time", "--continuum-time", "TIME", std::string(),
       "time of the continuum frame; with --lattice-time it may differ");
  keep(compare_command, compared, "tolerances", "--tolerance", "FIELD=VALUE", Words(),
       "FIELD=VALUE, largest relative root-mean-square difference that holds; repeatable");
  keep(compare_command, compared, "overlap", "--overlap",
       "compare where both sheets are; one may be a part of the other, as around a crack");
  keep(compare_command, compared, "excluded", "--exclude", "X,Y,R", Words(),
       "X,Y,R, centre and radius of a circle in the undeformed sheet whose sites are not compared, as at a "
       "crack tip; repeatable");

  std::string directory;
  bool animation = false;
  CLI::App *report_command =
    add_command("report", "summary table, pictures and report.html of finished runs", "latcon report output/quick",
                [&] {
                  return continue_in_python(options, "report", {directory}, {{"animation", animation}});
                });
  add_word(report_command, "DIR", directory,
           "output directory of a run, or a folder of several; with --output-dir it is only read")
    ->required();
  report_command->add_flag("--animation", animation, "draw animation.gif of each crack as well");

  CLI::App *init_command = add_command("init", "a folder with a commented case to start from", "latcon init my-strip",
                                       [&] { return continue_in_python(options, "init", {directory}, {}); });
  add_word(init_command, "DIR", directory, "folder; the case in it has its name")->required()->check(no_tilde);

  std::string section;
  CLI::App *entries_command =
    add_command("entries", "entries of a case: name, unit, default, meaning", "latcon entries Fracture",
                [&] { return continue_in_python(options, "entries", {section}, {}); });
  add_word(entries_command, "SECTION", section, "section whose entries to list; default: all");

  std::vector<std::string> topic; // names with blanks need no quotes
  CLI::App *help_command =
    add_command("help", "help on a command, a section or an entry of a case", "latcon help Fracture/toughening",
                [&] { return print_help(app, options, CLI::detail::join(topic, " ")); });
  add_word(help_command, "TOPIC", topic, "command, section, or entry (Section/Name or its name alone)");

  CLI::App *schema_command =
    add_command("schema", "all entries of a case as JSON, with the values of one", "latcon schema quick",
                [&]
                {
                  options.case_is_given = is_given("schema", "CASE");
                  return print_schema(options);
                });
  add_word(schema_command, "CASE", options.case_file, "case whose values to print; default: declarations only");

  return run_command(
    [&]
    {
      try
      {
        app.parse(argc, argv);
      }
      catch (const CLI::ParseError &error)
      {
        // Help and version are exceptions of CLI11 as well, with exit code 0.
        if (error.get_exit_code() != 0)
          throw support::InputError(usage_error(app, error));
        if (support::is_root_rank())
          app.exit(error);
        return support::ExitCode::done;
      }
      options.case_file = input::case_path(options.case_file);
      set_up_threads(options);
      return command();
    });
}

} // namespace latcon::commands
