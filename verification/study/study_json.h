/// Strict reading of JSON: whatever is not asked for, or is not what was asked for, is a problem.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace latcon::study
{

/// A place in a JSON document, and the list of problems that all places of the document share.
class JsonPlace
{
public:
  using Json = nlohmann::ordered_json;

  /// @param path of the place, "runs/fig1/seeds"; empty at the top
  JsonPlace(const Json &value, std::string file, std::string path, std::vector<std::string> &problems)
    : value_(&value), file_(std::move(file)), path_(std::move(path)), problems_(&problems)
  {
  }

  const Json &value() const { return *value_; }
  /// "FILE: PATH".
  std::string place() const { return path_.empty() ? file_ : file_ + ": " + path_; }
  void problem(const std::string &text) const { problems_->push_back(place() + ": " + text); }

  /// Whether this is an object without keys other than these; what is wrong is noted.
  bool is_object(const std::vector<std::string> &known) const;
  bool has(const std::string &key) const { return value_->is_object() && value_->contains(key); }
  /// A member, which must be there.
  JsonPlace at(const std::string &key) const { return child(value_->at(key), key); }
  /// A member; an empty place, and a problem, if it is missing.
  std::optional<JsonPlace> required(const std::string &key) const;

  /// Text of a member, which may be missing or empty.
  std::string optional_text(const std::string &key) const;

  // Values; one of another type is a problem, and gives an empty one.
  std::string text() const;
  double number() const;
  bool boolean() const;
  std::vector<JsonPlace> list() const;                            ///< not empty
  std::vector<std::pair<std::string, JsonPlace>> members() const; ///< of an object, in their order
  std::string word(const std::vector<std::string> &known, const std::string &what) const; ///< one of the known ones

private:
  JsonPlace child(const Json &value, const std::string &key) const
  {
    return {value, file_, path_.empty() ? key : path_ + "/" + key, *problems_};
  }

  const Json *value_;
  std::string file_, path_;
  std::vector<std::string> *problems_;
};

/// Parses a JSON object in which no key comes twice. @param file name for messages @throws InputError
[[nodiscard]] nlohmann::ordered_json parse_json(const std::string &text, const std::string &file);

/// "; nearest: WORD" for a word that was mistyped; empty if none could be meant.
[[nodiscard]] std::string nearest_hint(const std::string &given, const std::vector<std::string> &known);

} // namespace latcon::study
