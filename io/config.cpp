#include "swiftlet/io/config.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <exception>
#include <sstream>
#include <utility>

#include "swiftlet/io/config_tree.hpp"
#include "swiftlet/io/nearest_name.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {

namespace {

// A number as a person would write it: 0.1, not 0.10000000000000001.
std::string format_value(double number) {
  std::ostringstream out;
  out << number;
  return out.str();
}

std::string alternatives(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) out += i + 1 == names.size() ? " or " : ", ";
    out += names[i];
  }
  return out;
}

std::string unknown_key(const std::vector<std::string>& known, const std::string& key) {
  if (known.empty()) return "is unknown, must be left out";
  return "is unknown, must be one of " + alternatives(known) + or_nearest(known, key) + typography_in(key);
}

}  // namespace

bool Bounds::contains(double value) const {
  return (min_open ? value > min : value >= min) && (max_open ? value < max : value <= max);
}

std::string Bounds::to_string() const {
  std::string out;
  if (std::isfinite(min)) out = (min_open ? "above " : "at least ") + format_value(min);
  if (std::isfinite(max))
    out += (out.empty() ? "" : " and ") + std::string(max_open ? "below " : "at most ") + format_value(max);
  return out.empty() ? "a finite number" : out;
}

namespace {

using Value = ConfigNode::Value;

ConfigError missing_key(const std::string& file, const Value& missing) {
  return {file, missing.line, missing.key, "is missing, must be given"};
}

void reject_unknown(const std::string& file, const Value& value) {
  for (std::size_t i = 0; i < value.children.size(); ++i) {
    const Value& child = *value.children[i];
    if (value.kind == NodeKind::kMap && !value.open &&
        std::find(value.read_keys.begin(), value.read_keys.end(), value.names[i]) == value.read_keys.end()) {
      throw ConfigError(file, child.line, child.key, unknown_key(value.read_keys, value.names[i]));
    }
    reject_unknown(file, child);
  }
}

}  // namespace

ConfigNode::ConfigNode(std::shared_ptr<Tree> tree, Value* value) : tree_(std::move(tree)), value_(value) {}

void ConfigNode::fail(const std::string& message) const {
  throw ConfigError(tree_->file, value_->line, value_->key, message);
}

void ConfigNode::fail_type(const std::string& wanted) const {
  fail("is " + value_->describe() + ", must be " + wanted);
}

bool ConfigNode::is_missing() const { return value_->kind == NodeKind::kMissing; }

std::optional<ConfigNode> ConfigNode::find(const std::string& key) const {
  if (is_missing()) return std::nullopt;
  if (value_->kind != NodeKind::kMap) fail_type("a map");
  value_->mark_read(key);
  Value* const child = value_->child(key);
  if (child == nullptr) return std::nullopt;
  return ConfigNode(tree_, child);
}

ConfigNode ConfigNode::at(const std::string& key) const {
  if (const auto child = find(key)) return *child;
  Value absent;
  absent.kind = NodeKind::kMissing;
  absent.line = value_->line;
  absent.key = value_->key.empty() ? key : value_->key + "." + key;
  if (!tree_->collects_missing) throw missing_key(tree_->file, absent);
  tree_->missing.push_back(std::move(absent));
  return {tree_, &tree_->missing.back()};
}

void ConfigNode::read_known(const std::function<void()>& read) const {
  tree_->collects_missing = true;
  try {
    read();
  } catch (const std::exception&) {
    tree_->collects_missing = false;
    if (!tree_->missing.empty()) throw missing_key(tree_->file, tree_->missing.front());
    throw;
  }
  tree_->collects_missing = false;
  reject_unknown(tree_->file, *value_);
  if (!tree_->missing.empty()) throw missing_key(tree_->file, tree_->missing.front());
}

void ConfigNode::allow(std::initializer_list<const char*> keys) const {
  if (is_missing()) return;
  if (value_->kind != NodeKind::kMap) fail_type("a map");
  const std::vector<std::string> known(keys.begin(), keys.end());
  for (std::size_t i = 0; i < value_->children.size(); ++i) {
    const std::string& name = value_->names[i];
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const Value& child = *value_->children[i];
    throw ConfigError(tree_->file, child.line, child.key, unknown_key(known, name));
  }
}

std::vector<std::pair<std::string, ConfigNode>> ConfigNode::entries() const {
  if (is_missing()) return {};
  if (value_->kind != NodeKind::kMap) fail_type("a map");
  value_->open = true;
  std::vector<std::pair<std::string, ConfigNode>> out;
  for (std::size_t i = 0; i < value_->children.size(); ++i) {
    out.emplace_back(value_->names[i], ConfigNode(tree_, value_->children[i].get()));
  }
  return out;
}

std::vector<ConfigNode> ConfigNode::items() const {
  return items(0, std::numeric_limits<std::size_t>::max());
}

std::vector<ConfigNode> ConfigNode::items(std::size_t min_count, std::size_t max_count) const {
  if (is_missing()) return std::vector<ConfigNode>(min_count, *this);
  const bool bounded = max_count != std::numeric_limits<std::size_t>::max();
  std::string wanted = "a list";
  if (min_count == max_count) {
    wanted += " of " + std::to_string(min_count);
  } else if (bounded) {
    wanted += " of " + std::to_string(min_count) + " to " + std::to_string(max_count);
  } else if (min_count > 0) {
    wanted += " of at least " + std::to_string(min_count);
  }
  if (value_->kind != NodeKind::kList) fail_type(wanted);
  if (value_->children.size() < min_count || value_->children.size() > max_count) {
    fail("is a list of " + std::to_string(value_->children.size()) + ", must be " + wanted);
  }
  std::vector<ConfigNode> out;
  out.reserve(value_->children.size());
  for (const auto& child : value_->children) out.emplace_back(tree_, child.get());
  return out;
}

double ConfigNode::number(const Bounds& bounds) const {
  if (is_missing()) return 0.0;
  if (value_->kind != NodeKind::kScalar || value_->quoted) fail_type("a number");
  std::string_view text = value_->scalar;
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool special = text == ".nan" || text == ".inf" || text == "-.inf" || text == ".NaN" ||
                       text == ".Inf" || text == "-.Inf";
  if (special || (end == text.data() + text.size() &&
                  (error == std::errc::result_out_of_range || !std::isfinite(number)))) {
    fail_type("a finite number");
  }
  if (error != std::errc() || end != text.data() + text.size()) fail_type("a number" + typography_in(text));
  if (!bounds.contains(number)) fail_type(bounds.to_string());
  return number;
}

std::int64_t ConfigNode::integer(std::int64_t min, std::int64_t max) const {
  if (is_missing()) return min;
  if (value_->kind != NodeKind::kScalar || value_->quoted) fail_type("a whole number");
  const std::string& text = value_->scalar;
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool whole = end == text.data() + text.size();
  if (!whole || error == std::errc::invalid_argument) fail_type("a whole number" + typography_in(text));
  if (error == std::errc::result_out_of_range || number < min || number > max) {
    fail_type("a whole number from " + std::to_string(min) + " to " + std::to_string(max));
  }
  return number;
}

bool ConfigNode::boolean() const {
  if (is_missing()) return false;
  if (value_->kind != NodeKind::kScalar || value_->quoted ||
      (value_->scalar != "true" && value_->scalar != "false")) {
    fail_type("true or false");
  }
  return value_->scalar == "true";
}

std::string ConfigNode::text() const {
  if (is_missing()) return "";
  if (value_->kind != NodeKind::kScalar || value_->scalar.empty()) fail_type("a text");
  if (!std::all_of(value_->scalar.begin(), value_->scalar.end(), is_printable))
    fail_type("a text of one line");
  return value_->scalar;
}

std::ptrdiff_t ConfigNode::choice_index(const std::vector<std::string>& names) const {
  if (is_missing()) return 0;
  const auto it =
      value_->kind == NodeKind::kScalar ? std::find(names.begin(), names.end(), value_->scalar) : names.end();
  if (it == names.end()) {
    fail("is " + value_->describe() + ", must be " + alternatives(names) +
         (value_->kind == NodeKind::kScalar ? or_nearest(names, value_->scalar) : ""));
  }
  return it - names.begin();
}

std::vector<double> ConfigNode::numbers(std::size_t min_count, std::size_t max_count,
                                        const Bounds& bounds) const {
  std::vector<double> out;
  for (const ConfigNode& item : items(min_count, max_count)) out.push_back(item.number(bounds));
  return out;
}

Eigen::Vector3d ConfigNode::vector3(const Bounds& bounds) const {
  const std::vector<double> values = numbers(3, 3, bounds);
  return {values[0], values[1], values[2]};
}

ConfigNode ConfigNode::quantity(const std::string& unit) const {
  if (is_missing()) return *this;
  if (value_->kind != NodeKind::kMap) fail_type("a map {value, unit, source}");
  ConfigNode value = at("value");
  at("unit").choice<int>({{unit.c_str(), 0}});
  at("source").text();
  return value;
}

bool ConfigNode::is_map() const { return value_->kind == NodeKind::kMap; }
bool ConfigNode::is_list() const { return value_->kind == NodeKind::kList; }
bool ConfigNode::is_scalar() const { return value_->kind == NodeKind::kScalar; }

void ConfigNode::reject_unknown_keys() const { reject_unknown(tree_->file, *value_); }

ConfigNode ConfigNode::nearest(const std::string& key) const {
  const std::string path = value_->key.empty() ? key : value_->key + "." + key;
  const auto leads_to_path = [&path](const std::unique_ptr<Value>& child) {
    const std::size_t length = child->key.size();
    return path.compare(0, length, child->key) == 0 &&
           (path.size() == length || path[length] == '.' || path[length] == '[');
  };
  Value* value = value_;
  while (true) {
    const auto it = std::find_if(value->children.begin(), value->children.end(), leads_to_path);
    if (it == value->children.end()) return {tree_, value};
    value = it->get();
  }
}

const std::string& ConfigNode::file() const { return tree_->file; }
const std::string& ConfigNode::key() const { return value_->key; }
int ConfigNode::line() const { return value_->line; }

}  // namespace swiftlet::io
