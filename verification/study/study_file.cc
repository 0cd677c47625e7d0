#include "verification/study/study_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "support/errors.h"
#include "verification/input/case.h"
#include "verification/input/case_text.h"
#include "verification/input/input_file.h"
#include "verification/study/quantities.h"
#include "verification/study/study_json.h"
#include "verification/study/sweep.h"

namespace latcon::study
{
namespace
{

// Entry of a case that a study may change or vary.
struct CaseEntry
{
  std::string key, unit;
};

std::vector<CaseEntry> case_entries()
{
  input::Case input;
  input::Parameters parameters;
  input.declare(parameters);
  std::vector<CaseEntry> entries;
  for (const auto &[key, value] : parameters.values())
    entries.push_back({key, parameters.unit(key)});
  return entries;
}

// Settings and seeds in an object of the file; none if absent.
struct Change
{
  Settings set;
  std::vector<std::uint64_t> seeds;
};

class Reader
{
public:
  Reader(const std::string &path, bool quick) : quick_(quick)
  {
    study_.file = path;
    for (const CaseEntry &entry : case_entries())
    {
      entries_.push_back(entry.key);
      units_[entry.key] = entry.unit;
    }
  }

  Study read(const std::string &text)
  {
    const nlohmann::ordered_json document = parse_json(text, study_.file);
    const JsonPlace top(document, study_.file, "", problems_);
    top.is_object(
      {"title", "base", "side", "set", "seeds", "quick", "sweep", "refine", "runs", "claims", "pictures"});
    if (const auto title = top.required("title"))
      study_.title = title->text();
    if (const auto base = top.required("base"))
      study_.base = (std::filesystem::path(study_.file).parent_path() / base->text()).lexically_normal();
    on_continuum_ = is_on_continuum(top, false);
    whole_ = change(top);
    if (top.has("quick"))
    {
      top.at("quick").is_object({"set", "seeds", "sweep", "refine"});
      quick_change_ = change(top.at("quick"));
    }
    study_.settings = whole_.set;
    if (quick_)
      override_settings(study_.settings, quick_change_.set);
    sweeps(top);
    refinement(top, "");
    if (top.has("quick"))
      refinement(top.at("quick"), " of the study");
    if (const auto runs = top.has("sweep") && !top.has("runs") ? std::nullopt : top.required("runs"))
    {
      for (const auto &[name, place] : runs->members())
        run(name, place);
      if (study_.runs.empty() && problems_.empty())
        runs->problem("no run is left");
    }
    if (top.has("claims"))
      for (const JsonPlace &place : top.at("claims").list())
        claim(place);
    if (top.has("pictures"))
      for (const JsonPlace &place : top.at("pictures").list())
        study_.pictures.push_back(known_run(place));
    if (!problems_.empty())
      throw support::InputError(problems_);
    return std::move(study_);
  }

private:
  Change change(const JsonPlace &place)
  {
    Change found;
    if (place.has("set"))
      found.set = settings(place.at("set"));
    if (place.has("seeds"))
      found.seeds = seeds(place.at("seeds"));
    return found;
  }

  Settings settings(const JsonPlace &place)
  {
    Settings found;
    for (const auto &[key, value] : place.members())
    {
      if (std::find(entries_.begin(), entries_.end(), key) == entries_.end())
        value.problem("not an entry of a case" + nearest_hint(key, entries_));
      else if (key == seed_entry)
        value.problem("is set by \"seeds\"");
      else if (value.value().is_string())
        found.emplace_back(key, value.text());
      else if (value.value().is_number() || value.value().is_boolean())
        found.emplace_back(key, value.value().dump());
      else
        value.problem("must be a text, a number, true or false");
    }
    return found;
  }

  static std::vector<std::uint64_t> seeds(const JsonPlace &place)
  {
    std::vector<std::uint64_t> found;
    for (const JsonPlace &seed : place.list())
      if (!seed.value().is_number_unsigned())
        seed.problem("must be a whole number >= 0");
      else if (std::find(found.begin(), found.end(), seed.value().get<std::uint64_t>()) != found.end())
        seed.problem("this seed is given twice");
      else
        found.push_back(seed.value().get<std::uint64_t>());
    return found;
  }

  // Whether runs break the finite elements. @param otherwise without the key
  static bool is_on_continuum(const JsonPlace &place, const bool otherwise)
  {
    return place.has("side") ? place.at("side").word({"lattice", "continuum"}, "side") == "continuum" : otherwise;
  }

  void run(const std::string &name, const JsonPlace &place)
  {
    const auto allowed = [](const unsigned char c) { return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-'; };
    if (name.empty() || name.front() == '.' || !std::all_of(name.begin(), name.end(), allowed))
      place.problem("the name of a run must consist of letters, digits, '.', '_' and '-', and must not begin with '.'");
    const auto swept = names_.begin() + static_cast<std::ptrdiff_t>(n_swept_);
    if (std::find(names_.begin(), swept, name) != swept)
      place.problem("a run of the sweep has this name");
    names_.push_back(name);
    if (!place.is_object({"about", "side", "set", "seeds", "quick"}))
      return;
    StudyRun run{name, place.optional_text("about"), {}, {}, {}};
    run.on_continuum = is_on_continuum(place, on_continuum_);
    const Change own = change(place);
    Change small;
    bool left_out = false;
    if (place.has("quick"))
    {
      const JsonPlace quick = place.at("quick");
      if (quick.value().is_boolean())
        left_out = !quick.boolean();
      else if (quick.is_object({"set", "seeds"}))
        small = change(quick);
    }
    run.own = own.set;
    const auto first = [](std::initializer_list<const Change *> changes) -> std::vector<std::uint64_t>
    {
      for (const Change *change : changes)
        if (!change->seeds.empty())
          return change->seeds;
      return {1};
    };
    if (quick_)
    {
      override_settings(run.own, small.set);
      run.seeds = first({&small, &quick_change_, &own, &whole_});
    }
    else
      run.seeds = first({&own, &whole_});
    run.all = study_.settings;
    override_settings(run.all, run.own);
    if (quick_ && left_out)
      study_.left_out.push_back(name);
    else
      study_.runs.push_back(std::move(run));
  }

  // Adds a run for each combination of the values of the sweeps in the wanted size, and the names of those of the full
  // size, about which there may be claims.
  void sweeps(const JsonPlace &top)
  {
    const bool has_quick = top.has("quick") && top.at("quick").has("sweep");
    if (!top.has("sweep"))
    {
      if (has_quick)
        top.at("quick").at("sweep").problem("needs the key 'sweep' of the study");
      return;
    }
    const std::vector<std::uint64_t> seeds = whole_.seeds.empty() ? std::vector<std::uint64_t>{1} : whole_.seeds;
    const std::vector<std::uint64_t> &quick_seeds = quick_change_.seeds.empty() ? seeds : quick_change_.seeds;
    const std::vector<SweptCase> full = sweep(top.at("sweep"), seeds.size(), !quick_ || !has_quick);
    const std::vector<SweptCase> small =
      has_quick ? sweep(top.at("quick").at("sweep"), quick_seeds.size(), quick_) : full;
    std::set<std::string> names;
    for (const SweptCase &combination : quick_ ? small : full)
    {
      StudyRun run;
      run.name = combination.name;
      run.own = combination.set;
      run.all = study_.settings;
      override_settings(run.all, run.own);
      run.seeds = quick_ ? quick_seeds : seeds;
      run.on_continuum = on_continuum_;
      run.is_swept = true;
      names.insert(run.name);
      names_.push_back(run.name);
      study_.runs.push_back(std::move(run));
    }
    for (const SweptCase &combination : full)
      if (names.insert(combination.name).second)
      {
        names_.push_back(combination.name);
        study_.left_out.push_back(combination.name);
      }
    n_swept_ = names_.size();
  }

  // Combinations of the values of sweeps; none if there is a problem. @param is_run whether this study runs them
  std::vector<SweptCase> sweep(const JsonPlace &place, const std::size_t n_seeds, const bool is_run)
  {
    try
    {
      std::vector<Sweep> found;
      for (const JsonPlace &text : place.list())
        found.push_back(parse_sweep(text.text()));
      std::vector<SweptCase> cases = combinations(found, n_seeds);
      for (const Sweep &of_entry : found)
        if (is_run)
        {
          study_.swept.push_back(of_entry.entry);
          is_continuous_ = is_continuous_ && is_continuous(of_entry);
        }
      return cases;
    }
    catch (const support::InputError &error)
    {
      place.problem(error.what());
      return {};
    }
  }

  // Reads the number of refinements of the study, or of its quick version.
  void refinement(const JsonPlace &of, const std::string &owner)
  {
    if (!of.has("refine"))
      return;
    const JsonPlace place = of.at("refine");
    constexpr std::size_t max_refine = 6; // spacings below a hundredth of the grid's
    if (!place.value().is_number_unsigned() || place.value().get<std::uint64_t>() > max_refine)
      place.problem("must be a whole number from 0 to " + std::to_string(max_refine));
    else if (place.value() > 0 && study_.swept.empty())
      place.problem("needs the key 'sweep'" + owner);
    else if (place.value() > 0 && !is_continuous_)
      place.problem("needs sweeps of numbers that are not whole");
    else if (owner.empty() || quick_)
      study_.refine = place.value().get<std::size_t>();
  }

  std::string known_run(const JsonPlace &place) const { return place.word(names_, "run"); }

  void claim(const JsonPlace &place)
  {
    if (!place.is_object({"claim", "paper", "rows", "note"}))
      return;
    StudyClaim claim;
    if (const auto text = place.required("claim"))
      claim.claim = text->text();
    claim.paper = place.optional_text("paper");
    claim.note = place.optional_text("note");
    if (const auto rows = place.required("rows"))
      for (const JsonPlace &row : rows->list())
        claim.rows.push_back(read_row(row));
    study_.claims.push_back(std::move(claim));
  }

  StudyRow read_row(const JsonPlace &place)
  {
    StudyRow row;
    row.place = place.place();
    if (!place.is_object({"run", "runs", "quantity", "is", "is near", "tolerance", "above", "below", "rises", "falls",
                          "bracket", "onset exponent", "against", "quick"}))
      return row;
    if (place.has("run") == place.has("runs"))
      place.problem("a row needs either \"run\" or \"runs\"");
    else if (place.has("run"))
      row.runs = {known_run(place.at("run"))};
    else
      for (const JsonPlace &run : place.at("runs").list())
      {
        row.runs.push_back(known_run(run));
        if (std::count(row.runs.begin(), row.runs.end(), row.runs.back()) > 1 && !row.runs.back().empty())
          run.problem("'" + row.runs.back() + "' is given twice");
      }
    if (const auto quantity = place.required("quantity"))
      row.quantity = quantity->word(quantity_names(), "quantity");
    if (place.has("against"))
    {
      std::vector<std::string> known = entries_;
      known.insert(known.begin(), "zeta");
      const JsonPlace against = place.at("against");
      row.against = against.text();
      if (std::find(known.begin(), known.end(), row.against) == known.end())
        against.problem("must be zeta or an entry of a case" + nearest_hint(row.against, known));
      else
        row.against_unit = units_.at(row.against);
    }
    read_rule(place, row);
    if (place.has("quick") && !place.at("quick").boolean() && quick_)
      row.rule = Rule::reported;
    return row;
  }

  void read_rule(const JsonPlace &place, StudyRow &row)
  {
    static const std::map<std::string, Rule> rules{
      {"is", Rule::is},           {"is near", Rule::is_near},
      {"above", Rule::above},     {"below", Rule::below},
      {"rises", Rule::rises},     {"falls", Rule::falls},
      {"bracket", Rule::bracket}, {"onset exponent", Rule::onset_exponent}};
    for (const auto &[key, rule] : rules)
      if (place.has(key))
      {
        if (row.rule != Rule::reported)
          place.problem("a row can have only one rule; the second one is \"" + key + "\"");
        row.rule = rule;
        read_rule_value(place.at(key), row);
      }
    const bool of_patterns = row.rule == Rule::is || row.rule == Rule::bracket;
    if (row.rule != Rule::reported && !row.quantity.empty() && of_patterns != (row.quantity == pattern_quantity))
      place.problem(of_patterns ? "this rule is only for the quantity \"pattern\""
                                : "this rule is only for numbers, not for patterns");
    const bool is_near = row.rule == Rule::is_near || row.rule == Rule::onset_exponent;
    if (place.has("tolerance") != is_near)
      place.problem("\"is near\" or \"onset exponent\" and \"tolerance\" must be given together");
    else if (is_near)
    {
      row.tolerance = place.at("tolerance").number();
      if (!(row.tolerance > 0.))
        place.at("tolerance").problem("must be larger than 0");
    }
    const bool along = is_along(row.rule);
    if (along && row.against.empty())
      place.problem("this rule needs \"against\"");
    if (along && row.runs.size() == 1)
      place.problem("this rule needs two runs or more");
  }

  void read_rule_value(const JsonPlace &place, StudyRow &row)
  {
    switch (row.rule)
    {
    case Rule::is:
      row.pattern = place.word(pattern_words(), "pattern");
      break;
    case Rule::bracket:
      if (place.is_object({"from", "to"}))
      {
        if (const auto from = place.required("from"))
          row.from = from->word(pattern_words(), "pattern");
        if (const auto to = place.required("to"))
          row.to = to->word(pattern_words(), "pattern");
        if (row.from == row.to && !row.from.empty())
          place.problem("the two patterns must differ");
      }
      break;
    case Rule::rises:
    case Rule::falls:
      if (!place.value().is_boolean() || !place.boolean())
        place.problem("must be true");
      break;
    case Rule::onset_exponent:
      row.bound = place.number();
      if (!(row.bound > 0.))
        place.problem("must be larger than 0");
      break;
    default:
      if (place.value().is_object())
      {
        if (place.is_object({"run"}) && place.has("run"))
          row.bound_run = known_run(place.at("run"));
        else
          place.problem("must be a number or {\"run\": NAME}");
        break;
      }
      row.bound = place.number();
      if (row.rule == Rule::is_near && place.value().is_number() && row.bound == 0.)
        place.problem("must not be 0, because the tolerance is relative");
    }
  }

  static std::vector<std::string> quantity_names()
  {
    std::vector<std::string> names{pattern_quantity};
    for (const StudyQuantity &quantity : quantities())
      names.push_back(quantity.name);
    return names;
  }

  bool quick_;
  std::vector<std::string> entries_;
  std::map<std::string, std::string> units_{{"zeta", "1"}}; // of everything that `against` can be
  std::vector<std::string> names_;                          // names of all runs of the file
  std::size_t n_swept_ = 0;                                 // the first of them, of sweeps
  bool is_continuous_ = true;                               // the values of the sweeps
  std::vector<std::string> problems_;
  Change whole_, quick_change_;
  bool on_continuum_ = false; // of runs that do not name their side
  Study study_;
};

} // namespace

Study read_study(const std::string &text, const std::string &path, const bool quick)
{
  return Reader(path, quick).read(text);
}

Study read_study_file(const std::string &path, const bool quick)
{
  const input::InputFile file = input::read_input_file(path);
  if (!file.problem.empty())
    throw support::InputError(input::printable(path) + ": cannot read the study: " + file.problem + "; give a " +
                              study_choices());
  return read_study(file.text, path, quick);
}

} // namespace latcon::study
