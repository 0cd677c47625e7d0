#pragma once

// A made-up case with an entry of each kind, and what reading a text as such a case comes to.

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "support/errors.h"
#include "verification/input/parameters.h"

namespace sample_case
{

using namespace latcon::input;

/// x > lower
struct Above : Range
{
  explicit Above(double lower) : Range({lower, false}, {infinity, false}) {}
};

enum class Law
{
  mooney_rivlin,
  linear
};

enum class Rule
{
  none,
  behind_tip,
  retraction
};

// A case with one entry of each kind; `spacing` is required.
struct Sample
{
  double spacing = 0.;
  double area_factor = 0.6667;
  int steps = 100;
  unsigned int rows = 3;
  std::uint64_t seed = 7;
  bool periodic = false;
  std::string title = "sample";
  Law law = Law::mooney_rivlin;
  Rule rule = Rule::none;
  std::vector<double> stretches = {1., 2.};
  std::optional<double> time_step;
  double density = 1.;

  void declare(Parameters &p)
  {
    p.add("Lattice", "spacing", spacing, Above(0.), "m", "Distance d of nearest sites", Presence::required);
    p.add("Lattice", "nearest neighbour area factor", area_factor, Range(0., 1.), "1", "Share s of the area");
    p.add("Lattice", "rows", rows, Range(2), "Rows of sites");
    p.add("Lattice", "periodic", periodic, "Whether the ends are joined");
    p.add("Lattice", "law", law, {{"mooney-rivlin", Law::mooney_rivlin}, {"linear", Law::linear}}, "Law of the bonds");
    p.add("Lattice", "density", density, Above(0.), "kg/m^2", "Mass per area");
    p.add("Fracture", "rule", rule,
          {{"none", Rule::none}, {"behind-tip", Rule::behind_tip}, {"retraction", Rule::retraction}},
          "Toughening rule");
    p.add("Fracture", "stretches", stretches, Above(0.), "1", "Stretches to visit");
    p.add("Run", "steps", steps, any_number, "Number of steps");
    p.add("Run", "seed", seed, any_number, "Seed of the noise");
    p.add("Run", "title", title, "Title of the output");
    p.add("Run", "time step", time_step, Above(0.), "s", "Time step");
  }
};

inline const std::string good = "subsection Lattice\n  set spacing = 1\nend\n";

inline std::vector<std::string> problems_of(Parameters &p)
{
  try
  {
    p.finish();
  }
  catch (const latcon::support::InputError &error)
  {
    EXPECT_EQ(error.exit_code(), latcon::support::ExitCode::bad_input);
    return error.problems();
  }
  return {};
}

// Problems of a case.
inline std::vector<std::string> problems(const std::string &text, const std::vector<std::string> &overrides = {},
                                         const std::string &name = "a.prm")
{
  Sample sample;
  Parameters p;
  sample.declare(p);
  p.read_text(text, name);
  p.read_overrides(overrides);
  return problems_of(p);
}

inline std::string problem(const std::string &text, const std::vector<std::string> &overrides = {},
                           const std::string &name = "a.prm")
{
  const std::vector<std::string> all = problems(text, overrides, name);
  EXPECT_EQ(all.size(), 1u) << text << "\n" << (all.empty() ? "no problem" : latcon::support::InputError(all).what());
  return all.size() == 1 ? all[0] : "";
}

// The one problem of a case whose Lattice section is good but for a further line, which is line 3.
inline std::string lattice_problem(const std::string &line)
{
  return problem("subsection Lattice\n  set spacing = 1\n  " + line + "\nend\n");
}

inline Sample read(const std::string &text, const std::vector<std::string> &overrides = {},
                   const std::string &name = "a.prm", std::string *lines = nullptr)
{
  Sample sample;
  Parameters p;
  sample.declare(p);
  p.read_text(text, name);
  p.read_overrides(overrides);
  p.finish();
  if (lines)
    *lines = p.lines();
  return sample;
}

inline std::string lines_of(const std::string &text, const std::vector<std::string> &overrides = {},
                            const std::string &name = "a.prm")
{
  std::string lines;
  read(text, overrides, name, &lines);
  return lines;
}

inline auto values(const Sample &s)
{
  return std::tie(s.spacing, s.area_factor, s.steps, s.rows, s.seed, s.periodic, s.title, s.law, s.rule, s.stretches,
                  s.time_step, s.density);
}

// Returns whether the parameters can be declared as in `declaration`; a programming error throws.
template <typename Declaration>
bool is_misuse(const Declaration &declaration)
{
  Parameters p;
  try
  {
    declaration(p);
  }
  catch (const std::logic_error &)
  {
    return true;
  }
  return false;
}

} // namespace sample_case
