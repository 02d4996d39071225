// Strict reader of YAML configuration. Every fault, from a missing file to a misspelt key, throws ConfigError
// with file, line, key, value and limit. No input causes any other exception.
//
//   const ConfigNode root = load_config("square.yaml");
//   const double speed = root.at("speed_m_s").number(above(0.0));
//   for (const ConfigNode& item : root.at("items").items()) add(item.at("position_ned_m").vector3());
//   root.reject_unknown_keys();  // or all of it in read_known(), for better messages
//
// The input is one UTF-8 document in block or flow style that ends with a newline. A last line without a
// newline is reported as a truncated file. Anchors, aliases and tags are refused.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::io {

// The valid range of a number. An open end excludes the bound itself.
struct Bounds {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;
  bool max_open = false;

  bool contains(double value) const;  // false for a NaN
  std::string to_string() const;      // "above 0 and at most 2"
};

inline Bounds any_number() { return {}; }
inline Bounds above(double min) { return {min, std::numeric_limits<double>::infinity(), true, false}; }
inline Bounds at_least(double min) { return {min, std::numeric_limits<double>::infinity(), false, false}; }
inline Bounds at_most(double max) { return {-std::numeric_limits<double>::infinity(), max, false, false}; }
inline Bounds between(double min, double max) { return {min, max, false, false}; }

// A value in a document: scalar, list or map. Cheap to copy; keeps the document alive. Reading is not
// thread-safe: the document records which keys have been read. All members throw ConfigError if the value
// does not have the requested type or range.
class ConfigNode {
 public:
  struct Tree;
  struct Value;
  ConfigNode(std::shared_ptr<Tree> tree, Value* value);

  // Map: the value of a key. at() throws if the key is missing, find() returns nothing. entries() returns all
  // keys with their values in the order of the file; the keys are then arbitrary.
  ConfigNode at(const std::string& key) const;
  std::optional<ConfigNode> find(const std::string& key) const;
  std::vector<std::pair<std::string, ConfigNode>> entries() const;

  // Map: throws for the first key that is not in this list; the message suggests the nearest listed key. Call
  // it before reading the keys: otherwise a misspelt key is reported as the correct key missing.
  void allow(std::initializer_list<const char*> keys) const;

  // List: its values, min_count to max_count of them.
  std::vector<ConfigNode> items() const;
  std::vector<ConfigNode> items(std::size_t min_count, std::size_t max_count) const;

  // Scalars. A number is plain decimal and finite: quotes, hexadecimal, .inf and .nan are refused.
  double number(const Bounds& bounds = any_number()) const;
  std::int64_t integer(std::int64_t min = std::numeric_limits<std::int64_t>::min(),
                       std::int64_t max = std::numeric_limits<std::int64_t>::max()) const;
  bool boolean() const;      // true or false
  std::string text() const;  // not empty, no control characters
  template <typename T>
  T choice(std::initializer_list<std::pair<const char*, T>> options) const {
    std::vector<std::string> names;
    for (const auto& option : options) names.emplace_back(option.first);
    return (options.begin() + choice_index(names))->second;
  }
  std::ptrdiff_t choice_index(const std::vector<std::string>& names) const;

  // Lists of numbers, each within bounds.
  std::vector<double> numbers(std::size_t min_count, std::size_t max_count,
                              const Bounds& bounds = any_number()) const;
  Eigen::Vector3d vector3(const Bounds& bounds = any_number()) const;

  // A quantity is a map {value, unit, source}. Returns its value. Throws if the unit is another, the source
  // is not a text, or a key is missing.
  ConfigNode quantity(const std::string& unit) const;

  bool is_map() const;
  bool is_list() const;
  bool is_scalar() const;

  // Throws for the first key, here or below, that has not been read. Call it on the root after reading.
  void reject_unknown_keys() const;

  // Runs `read`, which reads this map with all below, then throws for the first key that was not read, or else
  // for the first that was missing: of a misspelt key, the message names what the file has. Meanwhile a
  // missing key reads as 0, false, "", the first choice, or a list of these.
  void read_known(const std::function<void()>& read) const;

  // The deepest existing value along the path key ("rotors[1].spin"), relative to this node; this node itself
  // if no part of the path exists.
  ConfigNode nearest(const std::string& key) const;

  // Throws ConfigError for this value. message reads like "is 3, must be below 2".
  [[noreturn]] void fail(const std::string& message) const;

  const std::string& file() const;
  const std::string& key() const;  // from the root: "rotors[1].spin"; empty for the root
  int line() const;                // from 1

 private:
  bool is_missing() const;
  [[noreturn]] void fail_type(const std::string& wanted) const;

  std::shared_ptr<Tree> tree_;
  Value* value_;
};

// Returns the root, which is a map. file_name appears in messages only.
ConfigNode parse_config(std::string_view text, const std::string& file_name);
ConfigNode load_config(const std::string& path);

}  // namespace swiftlet::io
