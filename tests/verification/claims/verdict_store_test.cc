// Verdicts come back as they were stored, and only for the inputs for which they were found.
#include "tests/support/temporary_folder.h"
#include "tests/verification/claims/subjects.h"

#include "support/errors.h"
#include "verification/claims/verdict_store.h"
#include "verification/input/files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>

namespace verdict_store_test
{

using namespace latcon;
using claims::UnusableVerdicts;
using claims::verdict_key;
using claims::VerdictKey;
using claims::Verdicts;
using input::Case;
using input::sha256;

claims::Claim named(const std::string &name)
{
  claims::Claim claim;
  claim.name = name;
  return claim;
}

Verdicts some_verdicts()
{
  claims::ClaimOutcome outcome;
  outcome.results.add({"energy", "W, \"loaded\"", "J/m^3", 1. / 3., -0.0, {}, 1e-12, {1e-10, "round-off"}, true});
  outcome.results.add({"energy", "reported", "1", {}, std::numeric_limits<double>::infinity(), {}, 0.5, {}});
  outcome.table("speeds", {"wave", "k d"}).add({std::string("L"), 0.1});
  return Verdicts(outcome);
}

std::string replaced(std::string text, const std::string &from, const std::string &to)
{
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(VerdictKey, IsThatOfProgramClaimsSizeRanksAndInputs)
{
  const Case input = subjects::paper_case();
  const bridge::Laws lattice_laws = bridge::laws_of_lattice();
  const claims::Claim energy = named("energy");
  const std::string hash = verdict_key(input, {energy}, lattice_laws, true, 1).hash;
  EXPECT_EQ(hash.size(), 64u);
  EXPECT_EQ(verdict_key(input, {energy}, lattice_laws, true, 1).hash, hash);
  Case other = input;
  other.nearest.viscosity = 1e-300;
  claims::Claim of_program = named("steady-crack");
  of_program.is_about_program = true;
  for (const VerdictKey &changed :
       {verdict_key(input, {energy, named("prestretch")}, lattice_laws, true, 1),
        verdict_key(input, {energy}, lattice_laws, false, 1), verdict_key(input, {energy}, lattice_laws, true, 2),
        verdict_key(input, {energy}, bridge::all_laws(), true, 1), verdict_key(other, {energy}, lattice_laws, true, 1),
        verdict_key(input, {of_program}, lattice_laws, true, 1)})
    EXPECT_NE(changed.hash, hash) << changed.text;
  // What depends on nothing of a case has one key for all.
  EXPECT_EQ(verdict_key(other, {of_program}, bridge::all_laws(), true, 2).hash,
            verdict_key(input, {of_program}, lattice_laws, true, 1).hash);
  // Entries that a claim declares are inputs as well.
  claims::Claim reads_seed = energy;
  reads_seed.entries = {"Lattice/noise seed"};
  const std::string seed = "Lattice/noise seed=";
  EXPECT_NE(verdict_key(input, {reads_seed}, lattice_laws, true, 1).text.find(seed), std::string::npos);
  EXPECT_EQ(verdict_key(input, {energy}, lattice_laws, true, 1).text.find(seed), std::string::npos);
  // The program is the one that runs, with the module of the finite elements beside it.
  const std::string program =
    sha256(sha256(content_of("/proc/self/exe")) + " " + sha256(content_of(input::module_file())));
  EXPECT_NE(verdict_key(input, {}, lattice_laws, true, 1).text.find("program=" + program), std::string::npos);
}

TEST(Verdicts, ComeBackAsTheyWere)
{
  const VerdictKey key("inputs=1\n");
  const Verdicts stored = some_verdicts();
  const Verdicts read = read_verdicts(key, verdicts_text(key, stored));
  EXPECT_EQ(read.results.json(), stored.results.json());
  EXPECT_TRUE(std::signbit(read.results.rows()[0].continuum.value()));
  EXPECT_EQ(read.tables, stored.tables);
  EXPECT_EQ(read.checked_at, stored.checked_at);
  EXPECT_EQ(stored.checked_at.size(), std::string("2026-11-21T16:20:05Z").size());
  EXPECT_EQ(stored.checked_at.back(), 'Z');
}

TEST(Verdicts, OfOtherInputsOrDamagedAreNotUsed)
{
  const VerdictKey key("inputs=1\n");
  const std::string text = verdicts_text(key, some_verdicts());
  EXPECT_THROW((void)read_verdicts(VerdictKey("inputs=2\n"), text), UnusableVerdicts);
  // The name is right and what is inside is not.
  EXPECT_THROW((void)read_verdicts(key, replaced(text, "inputs=1", "inputs=2")), UnusableVerdicts);
  EXPECT_THROW((void)read_verdicts(key, replaced(text, "0.333", "\"third\"")), UnusableVerdicts);
  for (std::size_t length = 0; length + 2 < text.size(); length += 7)
    EXPECT_THROW((void)read_verdicts(key, text.substr(0, length)), UnusableVerdicts) << length;
  for (const char *other : {"[]", "null", "{}", "{\"inputs\": \"inputs=1\\n\"}"})
    EXPECT_THROW((void)read_verdicts(key, other), UnusableVerdicts) << other;
}

TEST(Verdicts, DoNotBelieveAWordAgainstItsNumbers)
{
  const VerdictKey key("inputs=1\n");
  auto document = nlohmann::ordered_json::parse(verdicts_text(key, some_verdicts()));
  EXPECT_EQ(read_verdicts(key, document.dump()).results.verdict(), output::Verdict::holds);
  document["results"]["claims"][0]["error"] = 1.;
  EXPECT_EQ(read_verdicts(key, document.dump()).results.verdict(), output::Verdict::fails);
}

// Shipped verdicts hold with updated libraries, not with others; those of the user hold with the same files.
TEST(Verdicts, HoldForTheLibrariesOfTheCheck)
{
  Verdicts verdicts = some_verdicts();
  EXPECT_FALSE(verdicts.libraries.empty());
  EXPECT_EQ(verdicts.library_problem(false), "");
  verdicts.libraries["/proc/self/exe"] = "7 bytes, 7";
  EXPECT_NE(verdicts.library_problem(false), "");
  EXPECT_EQ(verdicts.library_problem(true), "");
  verdicts.libraries["/none.so"] = "7 bytes, 7";
  EXPECT_NE(verdicts.library_problem(true), "");
}

TEST(VerdictFiles, AreOneAKey)
{
  const TemporaryFolder folder;
  const std::string store = folder / "a/b";
  const VerdictKey first("1"), second("2");
  EXPECT_FALSE(claims::stored_text(claims::verdicts_file(store, first)));
  Verdicts verdicts = some_verdicts();
  for (const char *time : {"earlier", "later"})
  {
    verdicts.checked_at = time;
    store_verdicts(store, first, verdicts);
  }
  store_verdicts(store, second, verdicts);
  const std::string file = folder / ("a/b/" + first.hash + ".json");
  EXPECT_EQ(claims::verdicts_file(store, first), file);
  EXPECT_EQ(read_verdicts(first, content_of(file)).checked_at, "later");
  EXPECT_EQ(claims::stored_text(file), content_of(file));
  std::size_t n_files = 0;
  for (const auto &entry : std::filesystem::directory_iterator(store))
    n_files += entry.is_regular_file() ? 1 : 0;
  EXPECT_EQ(n_files, 2u); // nothing unfinished is left
}

TEST(VerdictFiles, SayThatTheyCannotBeReadOrWritten)
{
  const TemporaryFolder folder;
  const VerdictKey key("1");
  std::filesystem::create_directory(claims::verdicts_file(folder.path(), key));
  EXPECT_THROW((void)claims::stored_text(claims::verdicts_file(folder.path(), key)), UnusableVerdicts);
  EXPECT_THROW(store_verdicts(folder.path(), key, some_verdicts()), latcon::support::OutputError);
  std::ofstream(folder / "file") << "in the way";
  EXPECT_THROW(store_verdicts(folder / "file", key, some_verdicts()), latcon::support::OutputError);
  EXPECT_FALSE(claims::stored_text(claims::verdicts_file(folder / "file", key)));
}

TEST(VerdictFiles, AreInTheCacheOfTheUser)
{
  const auto set = [](const char *name, const std::optional<std::string> &text)
  { return text ? setenv(name, text->c_str(), 1) : unsetenv(name); };
  std::map<const char *, std::optional<std::string>> before{{"HOME", {}}, {"XDG_CACHE_HOME", {}}};
  for (auto &[name, text] : before)
    if (const char *const value = std::getenv(name))
      text = value;
  set("HOME", "/home/someone");
  set("XDG_CACHE_HOME", "/cache");
  EXPECT_EQ(claims::verdicts_folder_of_user(), "/cache/latcon/verdicts");
  for (const std::optional<std::string> &unusable :
       {std::optional<std::string>(), std::optional<std::string>(""), std::optional<std::string>("relative")})
  {
    set("XDG_CACHE_HOME", unusable);
    EXPECT_EQ(claims::verdicts_folder_of_user(), "/home/someone/.cache/latcon/verdicts");
  }
  set("HOME", {});
  EXPECT_FALSE(claims::verdicts_folder_of_user());
  for (const auto &[name, text] : before)
    set(name, text);
}

// What a crack waits for must have been judged; the same rule for verdicts of this run and for cached ones.
TEST(Verdicts, AreAcceptedOnlyIfEveryClaimJudgedSomething)
{
  const std::vector<claims::Claim> required{named("energy"), named("prestretch")};
  const auto row = [](const std::string &claim, bool gate)
  {
    latcon::output::Result result{claim, "NN: quantity", "1", 1., 1., {}, 1e-12, {1e-10, "round-off"}};
    result.gate = gate;
    return result;
  };
  Verdicts verdicts;
  latcon::output::Result reported = row("prestretch", true);
  reported.tolerance.reset();
  for (const latcon::output::Result &next : {row("energy", true), row("prestretch", false), reported})
  {
    verdicts.results.add(next);
    EXPECT_EQ(verdicts.acceptance_problem(required), "the claim prestretch judged nothing");
  }
  verdicts.results.add(row("prestretch", true));
  EXPECT_EQ(verdicts.acceptance_problem(required), "");
  verdicts.results.add(row("planted", true));
  EXPECT_NE(verdicts.acceptance_problem(required).find("planted"), std::string::npos);
}

TEST(Verdicts, HaveNoTableThatLeavesItsFolder)
{
  const VerdictKey key("inputs=1\n");
  for (const char *name : {"../../planted", "/tmp/planted", "a/planted", ""})
  {
    Verdicts verdicts = some_verdicts();
    verdicts.tables[name] = "1";
    EXPECT_THROW((void)read_verdicts(key, verdicts_text(key, verdicts)), UnusableVerdicts) << name;
  }
}

} // namespace verdict_store_test
