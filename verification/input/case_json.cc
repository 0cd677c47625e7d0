#include "verification/input/case_text.h"

#include <map>

#include <nlohmann/json.hpp>

namespace latcon::input
{
namespace
{

// Role of an object or a list that is open, or of the text itself.
enum class Role
{
  text,
  sections,
  entries, // of a section
  list,    // value of an entry
  ignored  // not understood, and reported
};

// Collects values as the JSON parser meets them, so that repeated keys and the digits of numbers are seen.
class CaseReader : public nlohmann::json_sax<nlohmann::json>
{
public:
  CaseReader(const std::string &name, CaseText &result) : name_(name), result_(result) {}

  bool null() override { return refuse("null"); }
  bool boolean(const bool value) override { return take(value ? "true" : "false"); }
  bool number_integer(const number_integer_t value) override { return take(std::to_string(value)); }
  bool number_unsigned(const number_unsigned_t value) override { return take(std::to_string(value)); }
  bool number_float(const number_float_t, const string_t &digits) override { return take(digits); }
  bool string(string_t &value) override { return take(value); }
  bool binary(binary_t &) override { return refuse("binary data"); }

  bool start_object(std::size_t) override
  {
    if (role() == Role::entries || role() == Role::list)
      refuse("an object");
    if (role() == Role::sections)
      result_.push_back(SectionStart{place(), section_});
    open_.push_back(role() == Role::text ? Role::sections : role() == Role::sections ? Role::entries : Role::ignored);
    return true;
  }

  bool start_array(std::size_t) override
  {
    if (role() != Role::entries)
      refuse("a list");
    open_.push_back(role() == Role::entries ? Role::list : Role::ignored);
    if (role() == Role::list)
      list_ = std::string();
    return true;
  }

  bool key(string_t &value) override
  {
    if (role() == Role::sections)
      section_ = value;
    else if (role() == Role::entries)
      key_ = value;
    return true;
  }

  bool end_object() override
  {
    if (role() == Role::entries)
      key_.clear();
    open_.pop_back();
    return true;
  }

  bool end_array() override
  {
    if (role() == Role::list && list_)
      result_.push_back(Assignment{place(), section_, key_, *list_});
    open_.pop_back();
    return true;
  }

  bool parse_error(std::size_t, const std::string &, const nlohmann::json::exception &exception) override
  {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: ..." holds the line, which is the better
    // place.
    std::string text = exception.what();
    const std::size_t bracket = text.find("] ");
    if (bracket != std::string::npos)
      text.erase(0, bracket + 2);
    std::string place = name_;
    const std::string prefix = "parse error at line ";
    const std::size_t comma = text.find(',');
    if (text.compare(0, prefix.size(), prefix) == 0 && comma != std::string::npos)
      place += ":" + text.substr(prefix.size(), comma - prefix.size());
    result_.push_back(SyntaxProblem{place, "not JSON: " + printable(text, 400), true});
    return false;
  }

private:
  [[nodiscard]] std::string place() const
  {
    return name_ + ":/" + printable(section_) + (key_.empty() ? "" : "/" + printable(key_));
  }

  [[nodiscard]] Role role() const { return open_.back(); }

  // Reports something where it does not belong.
  bool refuse(const std::string &what)
  {
    static const std::map<Role, std::string> allowed{
      {Role::text, " is not understood here; allowed: an object of sections"},
      {Role::sections, " is not understood here; allowed: an object with the entries of the section"},
      {Role::entries, " is not understood here; allowed: a number, a string, a boolean, or a list of those"},
      {Role::list, " in a list is not understood here; allowed: numbers, strings, booleans"}};
    if (role() != Role::ignored)
      result_.push_back(SyntaxProblem{place(), what + allowed.at(role())});
    if (role() == Role::list)
      list_.reset();
    return true;
  }

  bool take(const std::string &value)
  {
    if (role() == Role::entries)
      result_.push_back(Assignment{place(), section_, key_, trimmed(value)});
    else if (role() != Role::list)
      refuse("'" + printable(value) + "'");
    else if (list_)
      *list_ += (list_->empty() ? "" : ", ") + value;
    return true;
  }

  const std::string &name_;
  CaseText &result_;
  std::vector<Role> open_{Role::text};
  std::string section_;
  std::string key_;
  std::optional<std::string> list_; // none once something in it was not understood
};

} // namespace

CaseText read_json(const std::string &text, const std::string &name)
{
  if (const auto problem = zero_byte(text, name))
    return {*problem};
  CaseText result;
  CaseReader reader(name, result);
  // Comments are no JSON, but a case wants them, and the parser knows them.
  nlohmann::json::sax_parse(text, &reader, nlohmann::json::input_format_t::json, true, true);
  return result;
}

} // namespace latcon::input
