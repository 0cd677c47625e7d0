// Entries of a case that claims may read: every entry either changes the text or is listed here as unused.
#include "verification/claims/claim_inputs.h"

#include "support/errors.h"
#include "tests/verification/claims/subjects.h"
#include "verification/bridge/subject.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace claim_inputs_test
{

using namespace latcon;
using input::Case;
using input::Parameters;

// Sections of which no claim reads an entry, or those alone that name it in the table of claims: it may change without
// a check. Claims read only the ratio of the finite element side: they choose meshes, edges and solvers themselves.
const std::set<std::string> unread_sections{"Disorder",   "Lattice",       "Fracture",  "Nonlocal",    "Contact",
                                            "Time",       "Output",        "Near tip",  "Checkpoints", "Reference",
                                            "Body force", "Initial state", "Left edge", "Right edge",  "Bottom edge",
                                            "Top edge",   "Inner edge"};
const std::set<std::string> unread_entries{"Sheet/length",
                                           "Sheet/height",
                                           "Sheet/hole radius",
                                           "Sheet/notch length",
                                           "Loading/history times",
                                           "Loading/history strain x",
                                           "Loading/history strain y"};
const std::set<std::string> unread_of_shells{"plastic modulus", "yield stress", "hardening modulus"};

bool is_unread(const std::string &section, const std::string &name)
{
  return unread_sections.count(section) != 0 || unread_entries.count(section + "/" + name) != 0 ||
         unread_of_shells.count(name) != 0 || (section == "Continuum" && name != "ratio");
}

// All entries of a case with their values.
std::map<std::string, std::string> entries(Case input)
{
  Parameters parameters;
  input.declare(parameters);
  const auto values = parameters.values();
  return {values.begin(), values.end()};
}

// The case with one entry changed as little as it can be; none if nothing that is tried is another good value.
std::optional<Case> with_another(const std::string &key, const std::string &value)
{
  std::vector<std::string> candidates;
  try
  {
    std::size_t end = 0;
    const double number = std::stod(value, &end);
    std::ostringstream near;
    near.precision(17);
    near << number * (1. + 1e-12);
    if (end == value.size())
      candidates = {near.str(), std::to_string(std::lround(number) + 1)};
  }
  catch (const std::invalid_argument &)
  {
  }
  std::istringstream others("1e-12 1 0.5 2 false true rows-across-crack linear motion behind-tip rate-stretch slit "
                            "triangular mooney-rivlin isotropic generalised-alpha free held clamped undeformed "
                            "other.msh runge-kutta-chebyshev uniform");
  for (std::string other; others >> other;)
    candidates.push_back(other);
  for (const std::string &candidate : candidates)
  {
    Case changed = subjects::paper_case();
    Parameters parameters;
    changed.declare(parameters);
    std::vector<std::string> overrides{key + "=" + candidate};
    for (const auto &[required, text] : entries(subjects::paper_case()))
      if (required != key)
        overrides.push_back(required + "=" + text);
    parameters.read_overrides(overrides);
    try
    {
      parameters.finish();
    }
    catch (const latcon::support::InputError &)
    {
      continue;
    }
    if (entries(changed).at(key) != value)
      return changed;
  }
  return {};
}

TEST(ClaimInputs, EveryEntryChangesThemOrIsReadByNoClaim)
{
  const Case input = subjects::paper_case();
  const std::string text = claims::claim_inputs_text(input);
  std::size_t n_read = 0;
  for (const auto &[key, value] : entries(input))
  {
    const std::optional<Case> changed = with_another(key, value);
    ASSERT_TRUE(changed) << key << " = " << value << ": no other value was found to try";
    const std::size_t slash = key.find('/');
    const bool unread = is_unread(key.substr(0, slash), key.substr(slash + 1));
    EXPECT_EQ(claims::claim_inputs_text(*changed) == text, unread) << key << " = " << entries(*changed).at(key);
    n_read += unread ? 0 : 1;
  }
  EXPECT_EQ(n_read, 45u);
}

TEST(ClaimInputs, MakeTheSubjectOfTheCase)
{
  Case input = subjects::paper_case();
  input.orientation = lattice::Orientation::rows_across_crack;
  input.nearest.a = 1. / 3.;
  input.nearest.branch_moduli = {1e5 / 3., 2e5};
  input.nearest.relaxation_times = {1e-4 / 3., 1e-3};
  input.shear = 0.1;
  input.continuum.mooney_rivlin_ratio = 0.2;
  const bridge::Subject whole = bridge::subject(input);
  const bridge::Subject read = bridge::subject(claims::claim_inputs(input));
  EXPECT_EQ(read.spacing, whole.spacing);
  EXPECT_EQ(read.orientation, whole.orientation);
  EXPECT_EQ(read.deformation, whole.deformation);
  EXPECT_EQ(read.theory.shear_modulus, whole.theory.shear_modulus);
  const auto &branches = std::get<lattice::MaxwellMemory>(read.material.nearest.memory).branches();
  ASSERT_EQ(branches.size(), 2u);
  EXPECT_EQ(branches[0].modulus, 1e5 / 3.);
  EXPECT_EQ(branches[0].relaxation_time, 1e-4 / 3.);
  EXPECT_EQ(lattice::properties(read.material.next_nearest->memory).n_variables, 0u);
  EXPECT_EQ(read.theory.shear_speed, whole.theory.shear_speed);
  EXPECT_EQ(read.mooney_rivlin->ratio, whole.mooney_rivlin->ratio);
  EXPECT_EQ(read.mooney_rivlin->energy_residual, whole.mooney_rivlin->energy_residual);
}

// A claim that read an entry that is neither listed nor declared would find its default, whatever the case says.
TEST(ClaimInputs, HideWhatIsNeitherListedNorDeclared)
{
  Case input = subjects::paper_case();
  input.continuum.penalty = 7.;
  input.noise_seed = 42;
  const Case read = claims::claim_inputs(input);
  EXPECT_EQ(read.continuum.penalty, Case().continuum.penalty);
  EXPECT_EQ(read.noise_seed, Case().noise_seed);
  EXPECT_NE(read.length, input.length);
  EXPECT_EQ(claims::claim_inputs(input, {"Lattice/noise seed"}).noise_seed, 42u);
  EXPECT_EQ(claims::claim_inputs_text(input, {"Lattice/noise seed"}).size(),
            claims::claim_inputs_text(input).size() + std::string("Lattice/noise seed=42\n").size());
  EXPECT_THROW((void)claims::claim_inputs(input, {"Lattice/noise sed"}), std::logic_error);
}

} // namespace claim_inputs_test
