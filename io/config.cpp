#include "swiftlet/io/config.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <deque>
#include <exception>
#include <sstream>
#include <utility>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "swiftlet/io/nearest_name.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{4} << 20;
constexpr std::size_t kMaxDepth = 24;
constexpr std::size_t kMaxKeys = 1000;  // in one map
constexpr std::size_t kMaxShownLength = 60;

// Marks the end of the document. Without it yaml-cpp accepts an unterminated quote as a text that ends with
// the file.
constexpr const char* kDocumentEnd = "...\n";

enum class NodeKind { kMissing, kNull, kScalar, kList, kMap };

// A number as a person would write it: 0.1, not 0.10000000000000001.
std::string format_value(double number) {
  std::ostringstream out;
  out << number;
  return out.str();
}

// A text from the file, shortened and without control characters, for messages.
std::string format_value(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, kMaxShownLength)) out += is_printable(c) ? c : '?';
  if (text.size() > kMaxShownLength) {
    while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0xc0) == 0x80)
      out.pop_back();  // truncated UTF-8 character
    if (!out.empty() && (static_cast<unsigned char>(out.back()) & 0x80) != 0) out.pop_back();
    out += "...";
  }
  return out;
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
  return "is unknown, must be one of " + alternatives(known) + or_nearest(known, key);
}

// Refuses what is not a text file before the YAML parser reads it.
void check_text(std::string_view text, const std::string& file) {
  if (text.size() > kMaxBytes) {
    throw ConfigError(file, 0, "", "is too large, must hold at most " + std::to_string(kMaxBytes) + " bytes");
  }
  if (text.empty()) throw ConfigError(file, 0, "", "is empty, must be a YAML map");
  int line = 1;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    const std::size_t length = utf8_length(text.substr(i));
    if (length == 0 || (length == 1 && !is_printable(c) && c != '\n' && c != '\r' && c != '\t')) {
      throw ConfigError(file, line, "", "is not a text file, must be UTF-8 without control characters");
    }
    if (c == '\n') ++line;
    i += length;
  }
  if (text.back() != '\n') {
    throw ConfigError(file, line, "", "is truncated: the last line must end with a newline");
  }
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

struct ConfigNode::Value {
  NodeKind kind = NodeKind::kNull;
  int line = 0;
  std::string key;  // from the root
  std::string scalar;
  bool quoted = false;
  std::vector<std::unique_ptr<Value>> children;
  std::vector<std::string> names;      // keys of a map's children
  std::vector<std::string> read_keys;  // keys that the program has read
  bool open = false;                   // entries() has read all keys

  std::string describe() const {
    switch (kind) {
      case NodeKind::kMissing:
        return "missing";
      case NodeKind::kNull:
        return "empty";
      case NodeKind::kScalar:
        return quoted ? '"' + format_value(std::string_view(scalar)) + '"'
                      : format_value(std::string_view(scalar));
      case NodeKind::kList:
        return "a list";
      case NodeKind::kMap:
        return "a map";
    }
    return "";
  }

  Value* child(const std::string& name) const {
    const auto it = std::find(names.begin(), names.end(), name);
    return it == names.end() ? nullptr : children[static_cast<std::size_t>(it - names.begin())].get();
  }

  void mark_read(const std::string& name) {
    if (std::find(read_keys.begin(), read_keys.end(), name) == read_keys.end()) read_keys.push_back(name);
  }
};

struct ConfigNode::Tree {
  std::string file;
  std::unique_ptr<Value> root;
  bool collects_missing = false;  // in read_known()
  std::deque<Value> missing;      // keys that were missing in it, in the order of reading
};

namespace {

using Value = ConfigNode::Value;

// Builds the tree from the parser's events. Refuses unsupported YAML as soon as it occurs.
class TreeBuilder final : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::string file) : file_(std::move(file)) {}

  std::unique_ptr<Value> take_root() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (root_) fail(mark, "starts a second document, must be one");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    add(mark, "?", anchor, NodeKind::kNull, "");
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    fail(mark, "is an alias, must be written out");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    const bool null = tag == "?" && (value.empty() || value == "~" || value == "null");
    add(mark, tag, anchor, null ? NodeKind::kNull : NodeKind::kScalar, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, add(mark, tag, anchor, NodeKind::kList, ""));
  }
  void OnSequenceEnd() override { stack_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, add(mark, tag, anchor, NodeKind::kMap, ""));
  }
  void OnMapEnd() override { stack_.pop_back(); }

 private:
  struct Frame {
    Value* value = nullptr;
    bool has_name = false;  // map: the key has been read, its value is next
    int name_line = 0;
  };

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& message) const {
    throw ConfigError(file_, mark.line + 1, stack_.empty() ? "" : stack_.back().value->key, message);
  }

  void open(const YAML::Mark& mark, Value* value) {
    if (stack_.size() == kMaxDepth) {
      fail(mark, "is nested too deeply, must be at most " + std::to_string(kMaxDepth) + " levels");
    }
    stack_.push_back({value, false});
  }

  // Returns null if the scalar is a key of the map.
  Value* add(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, NodeKind kind,
             const std::string& text) {
    if (anchor != 0) fail(mark, "has an anchor, must be without");
    if (!tag.empty() && tag != "?" && tag != "!") {
      fail(mark, "has the tag " + format_value(std::string_view(tag)) + ", must be without");
    }
    if (!stack_.empty() && stack_.back().value->kind == NodeKind::kMap && !stack_.back().has_name) {
      if (kind != NodeKind::kScalar) fail(mark, "has a key that is not a text, must be a plain name");
      add_name(mark, text);
      return nullptr;
    }
    auto value = std::make_unique<Value>();
    value->kind = kind;
    value->line = mark.line + 1;
    value->scalar = text;
    value->quoted = tag == "!";
    Value* const raw = value.get();
    if (stack_.empty()) {
      if (root_) fail(mark, "starts a second document, must be one");
      root_ = std::move(value);
      return raw;
    }
    Frame& frame = stack_.back();
    if (frame.value->kind == NodeKind::kMap) {
      const std::string& name = frame.value->names.back();
      raw->key = frame.value->key.empty() ? name : frame.value->key + "." + name;
      raw->line = frame.name_line;
      frame.has_name = false;
    } else {
      raw->key = frame.value->key + "[" + std::to_string(frame.value->children.size()) + "]";
    }
    frame.value->children.push_back(std::move(value));
    return raw;
  }

  void add_name(const YAML::Mark& mark, const std::string& name) {
    Frame& frame = stack_.back();
    if (const Value* const first = frame.value->child(name)) {
      throw ConfigError(file_, mark.line + 1, first->key,
                        "is given twice, first in line " + std::to_string(first->line));
    }
    if (name.empty() || name.size() > kMaxShownLength ||
        !std::all_of(name.begin(), name.end(), is_printable)) {
      fail(mark, "has the key \"" + format_value(std::string_view(name)) + "\", must be one line of 1 to " +
                     std::to_string(kMaxShownLength) + " bytes");
    }
    if (frame.value->names.size() == kMaxKeys) {
      fail(mark, "has too many keys, must have at most " + std::to_string(kMaxKeys));
    }
    frame.value->names.push_back(name);
    frame.has_name = true;
    frame.name_line = mark.line + 1;
  }

  std::string file_;
  std::unique_ptr<Value> root_;
  std::vector<Frame> stack_;
};

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
  if (error != std::errc() || end != text.data() + text.size()) fail_type("a number");
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
  if (!whole || error == std::errc::invalid_argument) fail_type("a whole number");
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

ConfigNode parse_config(std::string_view text, const std::string& file_name) {
  check_text(text, file_name);
  TreeBuilder builder(file_name);
  try {
    std::istringstream stream{std::string(text) + kDocumentEnd};
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const ConfigError&) {
    throw;
  } catch (const YAML::Exception& e) {
    throw ConfigError(file_name, e.mark.is_null() ? 0 : e.mark.line + 1, "", "is not valid YAML: " + e.msg);
  } catch (const std::exception& e) {
    throw ConfigError(file_name, 0, "", std::string("cannot be read: ") + e.what());
  }
  auto tree = std::make_shared<ConfigNode::Tree>();
  tree->file = file_name;
  tree->root = builder.take_root();
  if (!tree->root || tree->root->kind == NodeKind::kNull)
    throw ConfigError(file_name, 0, "", "is empty, must be a YAML map");
  if (tree->root->kind != NodeKind::kMap) {
    throw ConfigError(file_name, tree->root->line, "",
                      "is " + tree->root->describe() + ", must be a YAML map");
  }
  ConfigNode::Value* const root = tree->root.get();
  return {std::move(tree), root};
}

ConfigNode load_config(const std::string& path) {
  return parse_config(read_text_file(path, kMaxBytes), path);
}

}  // namespace swiftlet::io
