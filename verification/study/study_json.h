/// Strict reader of JSON: unknown keys and values of another type are problems.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace latcon::study
{

/// Position in a JSON document, and the list of problems shared by all positions of the document.
class JsonPlace
{
public:
  using Json = nlohmann::ordered_json;

  /// @param path position, for example "runs/fig1/seeds"; empty at the top
  JsonPlace(const Json &value, std::string file, std::string path, std::vector<std::string> &problems)
    : value_(&value), file_(std::move(file)), path_(std::move(path)), problems_(&problems)
  {
  }

  const Json &value() const { return *value_; }
  /// Returns "FILE: PATH".
  std::string place() const { return path_.empty() ? file_ : file_ + ": " + path_; }
  void problem(const std::string &text) const { problems_->push_back(place() + ": " + text); }

  /// Returns true if this is an object; adds a problem if it is not, and for each unknown key.
  bool is_object(const std::vector<std::string> &known) const;
  bool has(const std::string &key) const;
  /// Returns a member, which must exist.
  JsonPlace at(const std::string &key) const;
  /// Returns a member; adds a problem and returns none if it is missing.
  std::optional<JsonPlace> required(const std::string &key) const;

  /// Returns the text of a member, which may be missing or empty.
  std::string optional_text(const std::string &key) const;

  // Values. For another type they add a problem and return an empty value.
  std::string text() const;
  double number() const;
  bool boolean() const;
  std::vector<JsonPlace> list() const;                            ///< non-empty list
  std::vector<std::pair<std::string, JsonPlace>> members() const; ///< members of an object, in their order
  std::string word(const std::vector<std::string> &known, const std::string &what) const; ///< one of `known`

private:
  JsonPlace child(const Json &value, const std::string &key) const
  {
    return {value, file_, path_.empty() ? key : path_ + "/" + key, *problems_};
  }

  const Json *value_;
  std::string file_, path_;
  std::vector<std::string> *problems_;
};

/// Parses a JSON object without repeated keys. @param file name for messages @throws InputError
[[nodiscard]] nlohmann::ordered_json parse_json(const std::string &text, const std::string &file);

/// Returns "; nearest: WORD" for a mistyped word; empty if no known word is similar.
[[nodiscard]] std::string nearest_hint(const std::string &given, const std::vector<std::string> &known);

} // namespace latcon::study
