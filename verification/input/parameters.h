/// Cases: named entries with unit, range and documentation, read from a file and from the command line.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace latcon::input
{

struct Assignment;

/// Range of numbers that an entry allows, in its SI unit.
struct Range
{
  /// One end of a range.
  struct Bound
  {
    double value;  ///< infinite for none
    bool included; ///< whether the value itself is allowed
  };

  Bound lower, upper;

  Range(Bound from, Bound to) : lower(from), upper(to) {}
  /// from <= x <= to
  explicit Range(double from, double to = infinity) : lower{from, true}, upper{to, to < infinity} {}

  /// Not-a-number and infinities are in no range.
  [[nodiscard]] bool contains(double value) const;

  /// For a message, e.g. "> 0 and <= 1"; empty if every number is allowed.
  [[nodiscard]] std::string text() const;

  static constexpr double infinity = std::numeric_limits<double>::infinity();
};

/// Every finite number.
inline const Range any_number({-Range::infinity, false}, {Range::infinity, false});
/// 1e-20 <= x <= 1e20: positive quantities in any system of units. Products of a dozen such numbers are finite.
inline const Range magnitude(1e-20, 1e20);
/// 0 <= x <= 1e20: as magnitude, or zero.
inline const Range magnitude_or_zero(0., 1e20);

/// Required and optional entries.
enum class Presence
{
  optional, ///< if omitted, the member keeps the value that it had when it was declared
  required  ///< no default is meaningful: omitting it is an error
};

/// Type of the value of an entry.
enum class ValueType
{
  number,       ///< real
  whole_number, ///< integer
  numbers,      ///< list of real numbers
  boolean,      ///< `true` or `false`
  word,         ///< one of several
  text          ///< any text on one line
};

/// Readers of an entry besides the runs of its case.
enum class ReadBy
{
  runs,                ///< nothing
  claims,              ///< every claim: verdicts depend on the entry
  claims_on_user_laws, ///< every claim, if a shell has a law of the user
};

/// Declaration of one entry of a case.
struct Declaration
{
  std::string section;
  std::string name;
  std::string documentation;
  std::string unit; ///< SI; "1" for a pure number, empty for entries that are no quantities
  std::string rule; ///< allowed values in few words, as in the documentation
  Presence presence = Presence::optional;
  ValueType type = ValueType::text;
  std::optional<Range> range{};                 ///< of numbers
  std::optional<std::uint64_t> largest_whole{}; ///< largest value of the integer type if `range` does not exclude it
  bool may_be_auto = false;                     ///< whether the word `auto` is allowed
  std::vector<std::string> words{};             ///< of ValueType::word
  std::string default_text{};                   ///< as a case file would hold it; meaningless if required
  ReadBy read_by = ReadBy::runs;                ///< set where the entry is declared

  [[nodiscard]] std::string key() const { return section + "/" + name; }
};

/// The entries of a case, each declared once, beside the member it fills.
///
/// Order of use: declare with add(); read_file() and read_overrides(); checks that concern several entries, which
/// report through error(); finish(), which throws one InputError with every problem found by any of them. A member is
/// filled as soon as a good value is read, so the checks see the members; it keeps its old value if the value read is
/// bad.
///
/// Case files have deal.II's parameter format (`subsection X`, `set name = value`, `end`, `#` starts a comment, `\` at
/// the end of a line continues it) or, if their name ends in `.json`, are JSON: one object per section, values as
/// numbers, strings, booleans, or arrays of numbers. Sections do not nest. A number is in the SI unit of its entry or
/// carries a unit: `0.625 mm`. The decimal digits are kept: `0.625 mm` is bitwise `0.000625`.
///
/// Members must be initialised, outlive this object and stay where they are. Misuse by the program (an entry declared
/// twice, a default out of range, a unit not known, an undeclared key in error()) throws std::logic_error.
class Parameters
{
public:
  Parameters() = default;
  Parameters(const Parameters &) = delete;
  Parameters &operator=(const Parameters &) = delete;

  /// A real number or, as std::optional, one that the program derives if it is the word `auto` (no value).
  /// @param section       section of the entry, at least one word; neither `/`, `#`, `=` nor line breaks
  /// @param name          name within the section, same rule; key of the entry is `section/name`
  /// @param member        filled, in SI; its present value is the default
  /// @param range         what is allowed, in `unit`
  /// @param unit          SI unit, e.g. "m", "kg/m^3", "N s/m"; "1" for a pure number
  /// @param documentation what it is, in words and symbol
  /// @tparam Number       double or std::optional<double>
  /// @return the declaration, valid until the next one, of which `read_by` may be set
  template <typename Number>
  Declaration &add(const std::string &section, const std::string &name, Number &member, const Range &range,
                   const std::string &unit, const std::string &documentation, Presence presence = Presence::optional);

  /// Real numbers, separated by commas, possibly none; `range` holds for each. All have a unit written, or none has.
  Declaration &add(const std::string &section, const std::string &name, std::vector<double> &member, const Range &range,
                   const std::string &unit, const std::string &documentation);

  /// Whole numbers. The range is compared in double precision, so bounds beyond 2^53 are blurred.
  /// @param member int, unsigned int or std::uint64_t
  template <typename Integer, typename = std::enable_if_t<std::is_integral_v<Integer>>>
  Declaration &add(const std::string &section, const std::string &name, Integer &member, const Range &range,
                   const std::string &documentation);

  /// `true` or `false`.
  Declaration &add(const std::string &section, const std::string &name, bool &member, const std::string &documentation);

  /// A text on one line, without `#`, not ending in `\`; blanks around it are lost.
  Declaration &add(const std::string &section, const std::string &name, std::string &member,
                   const std::string &documentation);

  /// One word out of several, each standing for a value of an enumeration.
  template <typename Enumeration, typename = std::enable_if_t<std::is_enum_v<Enumeration>>>
  Declaration &add(const std::string &section, const std::string &name, Enumeration &member,
                   const std::vector<std::pair<std::string, Enumeration>> &words, const std::string &documentation);

  /// Reads a case file; problems are kept for finish().
  /// @param path name of the file; JSON if it ends in `.json`, deal.II's format otherwise
  void read_file(const std::string &path);

  /// Reads a case from memory, as read_file() would.
  /// @param text the content
  /// @param name what messages call it; its ending decides on the format
  void read_text(const std::string &text, const std::string &name);

  /// Reads options of the form `Section/Name=value`; to be called after read_file(), whose values they replace. The
  /// same key twice among them is a problem. Problems are kept for finish().
  void read_overrides(const std::vector<std::string> &overrides);

  /// Reports that an entry is wrong in combination with others. Ignored if `key` or one of `also` is itself wrong or
  /// missing: the cause is then already reported.
  /// @param key  the wrong entry, as "Section/Name": the message states its value and position
  /// @param text what is wrong and what is allowed
  /// @param also the other entries that the check used
  void error(const std::string &key, const std::string &text, const std::vector<std::string> &also = {});

  /// Returns whether no problem has been found so far, as checks that compute with many entries require.
  [[nodiscard]] bool good() const;

  /// Ends reading.
  /// @throws InputError with all problems if there are any, also required entries that are missing.
  void finish();

  /// The case as it now stands in the members: deal.II's format, every entry with its documentation, in SI, full
  /// precision. Reading it back gives the members bit for bit.
  [[nodiscard]] std::string resolved_text() const;

  /// All keys and the values of the members as they now stand, as text that reads back to them bit for bit; by key.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> values() const;

  /// Names of all sections, in the order of their first entries.
  [[nodiscard]] std::vector<std::string> sections() const;

  /// All entries, in the order of declaration.
  [[nodiscard]] std::vector<Declaration> declarations() const;

  /// Value of an entry as it now stands in its member, as a case file would hold it. @throws std::logic_error for no
  /// entry
  [[nodiscard]] std::string value(const std::string &key) const { return find(key).write(); }

  /// A line `key = value` for each of values(), those of one section left out. Does not depend on how the case was
  /// written down (order, comments, units, file or override), nor on the order of declaration, nor on the machine.
  [[nodiscard]] std::string lines(const std::string &section_left_out = "") const;

private:
  struct Entry : Declaration
  {
    std::string allowed{}; // the rule for a message, with units
    // Fills the member, or returns what is wrong with the text.
    std::function<std::string(const std::string &)> read{};
    std::function<std::string()> write{}; // the member as text
    std::string text{};                   // as given
    std::string file_place{};             // where the file set it; empty if it did not
    bool overridden = false;
    bool wrong = false; // something about it has been reported

    // Whether the file or an override gave a value, valid or not.
    [[nodiscard]] bool is_set() const { return overridden || !file_place.empty(); }
    [[nodiscard]] std::string place() const; // where the value comes from
  };

  Declaration &declare(Entry entry);
  Declaration &add_words(const std::string &section, const std::string &name, const std::vector<std::string> &words,
                         const std::function<void(std::size_t)> &set, const std::function<std::size_t()> &get,
                         const std::string &documentation, ValueType type = ValueType::word);
  void take_override(const std::string &text);
  void set(const Assignment &assignment, const std::string &shown, bool is_override);
  void report(const std::string &place, const std::string &text);
  [[nodiscard]] const Entry &find(const std::string &key) const;
  [[nodiscard]] bool has_section(const std::string &section) const;
  [[nodiscard]] std::string known_entries(const std::string &section) const;
  [[nodiscard]] std::string nearest_section(const std::string &section) const;
  [[nodiscard]] std::string nearest_key(const std::string &section, const std::string &name) const;

  std::vector<Entry> entries_;              // in the order of declaration
  std::map<std::string, std::size_t> keys_; // to the index in entries_
  std::vector<std::string> problems_;
  std::size_t n_problems_ = 0; // also those beyond what is kept
  bool unreadable_ = false;    // a file could not be read, so missing entries mean nothing
  std::string file_ = "no case file";
};

template <typename Enumeration, typename>
Declaration &Parameters::add(const std::string &section, const std::string &name, Enumeration &member,
                             const std::vector<std::pair<std::string, Enumeration>> &words,
                             const std::string &documentation)
{
  std::vector<std::string> names;
  std::vector<Enumeration> values;
  for (const auto &[word, value] : words)
  {
    names.push_back(word);
    values.push_back(value);
  }
  return add_words(
    section, name, names, [&member, values](const std::size_t i) { member = values[i]; },
    [&member, values] { return std::find(values.begin(), values.end(), member) - values.begin(); }, documentation);
}

} // namespace latcon::input
