#include "verification/input/case_text.h"

#include <cstddef>

#include <nlohmann/json.hpp>

namespace latcon::input
{
namespace
{

// Collects values as the JSON parser meets them, so that repeated keys and the digits of numbers are seen.
class CaseReader
{
public:
  using number_integer_t = nlohmann::json::number_integer_t;
  using number_unsigned_t = nlohmann::json::number_unsigned_t;
  using number_float_t = nlohmann::json::number_float_t;
  using string_t = nlohmann::json::string_t;
  using binary_t = nlohmann::json::binary_t;

  CaseReader(const std::string &name, CaseText &result) : name_(name), result_(result) {}

  bool null() { return unsuitable("null"); }
  bool boolean(const bool value) { return take(value ? "true" : "false"); }
  bool number_integer(const number_integer_t value) { return take(std::to_string(value)); }
  bool number_unsigned(const number_unsigned_t value) { return take(std::to_string(value)); }
  bool number_float(const number_float_t, const string_t &digits) { return take(digits); }
  // cppcheck-suppress constParameter ; as the parser calls it
  bool string(string_t &value) { return take(value); }
  bool binary(binary_t &) { return unsuitable("binary data"); }

  bool start_object(std::size_t)
  {
    if (skipped_ > 0 || in_list_ || depth_ == 2)
      return skip("an object");
    if (depth_ == 1)
      result_.push_back(SectionStart{place(), section_});
    ++depth_;
    return true;
  }

  // cppcheck-suppress constParameter ; as the parser calls it
  bool key(string_t &value)
  {
    if (skipped_ == 0)
    {
      if (depth_ == 1)
        section_ = value;
      else
        key_ = value;
    }
    return true;
  }

  bool end_object()
  {
    if (skipped_ > 0)
      --skipped_;
    else
      --depth_;
    if (depth_ < 2)
      key_.clear();
    return true;
  }

  bool start_array(std::size_t)
  {
    if (skipped_ > 0 || in_list_ || depth_ < 2)
      return skip("a list");
    in_list_ = true;
    list_good_ = true;
    list_.clear();
    return true;
  }

  bool end_array()
  {
    if (skipped_ > 0)
    {
      --skipped_;
      return true;
    }
    in_list_ = false;
    if (list_good_)
      result_.push_back(Assignment{place(), section_, key_, list_});
    return true;
  }

  bool parse_error(std::size_t, const std::string &, const nlohmann::json::exception &exception)
  {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: ..." holds the line, which is the better
    // place.
    std::string text = exception.what();
    const std::size_t bracket = text.find("] ");
    if (bracket != std::string::npos)
      text.erase(0, bracket + 2);
    std::string place = name_;
    const std::string prefix = "parse error at line ";
    if (text.compare(0, prefix.size(), prefix) == 0)
    {
      const std::size_t comma = text.find(',');
      if (comma != std::string::npos)
        place += ":" + text.substr(prefix.size(), comma - prefix.size());
    }
    result_.push_back(SyntaxProblem{place, "not JSON: " + printable(text)});
    return false;
  }

private:
  [[nodiscard]] std::string place() const
  {
    return name_ + ":/" + printable(section_) + (key_.empty() ? "" : "/" + printable(key_));
  }

  // Reports something where it does not belong.
  bool unsuitable(const std::string &what)
  {
    const char *allowed = "an object of sections";
    if (in_list_)
      allowed = "numbers, strings, booleans";
    else if (depth_ == 1)
      allowed = "an object with the entries of the section";
    else if (depth_ == 2)
      allowed = "a number, a string, a boolean, or a list of those";
    if (skipped_ == 0)
      result_.push_back(
        SyntaxProblem{place(), what + (in_list_ ? " in a list" : "") + " is not understood here; allowed: " + allowed});
    list_good_ = false;
    return true;
  }

  // Skips an element together with its content.
  bool skip(const std::string &what)
  {
    unsuitable(what);
    ++skipped_;
    return true;
  }

  bool take(const std::string &value)
  {
    if (skipped_ > 0)
      return true;
    if (depth_ < 2)
      return unsuitable("'" + printable(value) + "'");
    if (in_list_)
      list_ += (list_.empty() ? "" : ", ") + value;
    else
      result_.push_back(Assignment{place(), section_, key_, trimmed(value)});
    return true;
  }

  const std::string &name_;
  CaseText &result_;
  std::size_t depth_ = 0;   // of objects: 1 among the sections, 2 among the entries of one
  std::size_t skipped_ = 0; // objects and lists that were not understood and are still open
  bool in_list_ = false;
  bool list_good_ = true;
  std::string section_;
  std::string key_;
  std::string list_;
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
