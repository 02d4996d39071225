// Builds the tree of a configuration file.
#include <exception>
#include <sstream>
#include <utility>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include "swiftlet/io/config_tree.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {
namespace {

using Value = ConfigNode::Value;

constexpr std::size_t kMaxBytes = std::size_t{4} << 20;
constexpr std::size_t kMaxDepth = 24;
constexpr std::size_t kMaxKeys = 1000;  // in one map
constexpr std::size_t kMaxShownLength = 60;

// Marks the end of the document. Without it yaml-cpp accepts an unterminated quote as a text that ends with
// the file.
constexpr const char* kDocumentEnd = "...\n";

// A text from the file, shortened and without control characters, for messages.
std::string shown(std::string_view text) {
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

// Refuses what is not a text file before the YAML parser reads it.
void check_text(std::string_view text, const std::string& file) {
  if (text.size() > kMaxBytes) {
    throw ConfigError(file, 0, "", "is too large, must hold at most " + std::to_string(kMaxBytes) + " bytes");
  }
  if (text.empty()) throw ConfigError(file, 0, "", "is empty, must be a YAML map");
  refuse_utf16(text, file);
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

// The parser reports an unclosed { or [ where the next one is. Throws ConfigError where it opens, if there is one: a bracket
// opens where a value may begin, and not within quotes or comments.
void refuse_unclosed(std::string_view text, const std::string& file) {
  std::vector<std::pair<char, int>> open;  // bracket and line
  char quote = 0;
  char before = '\n';  // the last character that is no blank
  int line = 1;
  const auto refuse = [&] {
    throw ConfigError(file, open.back().second, "",
                      std::string("is not valid YAML: the ") + open.back().first + " here is not closed");
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    const bool begins = std::string_view("\n:-,[{").find(before) != std::string_view::npos;
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '#' && (i == 0 || std::string_view(" \n").find(text[i - 1]) != std::string_view::npos)) {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (begins && (c == '"' || c == '\'')) {
      quote = c;
    } else if (begins && (c == '{' || c == '[')) {
      open.emplace_back(c, line);
    } else if (!open.empty() && (c == '}' || c == ']')) {
      if ((c == '}') != (open.back().first == '{')) refuse();
      open.pop_back();
    }
    if (c != ' ') before = c;
  }
  if (!open.empty()) refuse();
}

// The text from a line on; empty behind the last.
std::string_view from_line(std::string_view text, int number) {
  for (; number > 1 && !text.empty(); --number)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  return text;
}

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
      fail(mark, "has the tag " + shown(tag) + ", must be without");
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
      fail(mark, "has the key \"" + shown(name) + "\", must be one line of 1 to " +
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

}  // namespace

std::string ConfigNode::Value::describe() const {
  switch (kind) {
    case NodeKind::kMissing:
      return "missing";
    case NodeKind::kNull:
      return "empty";
    case NodeKind::kScalar:
      return quoted ? '"' + shown(scalar) + '"' : shown(scalar);
    case NodeKind::kList:
      return "a list";
    case NodeKind::kMap:
      return "a map";
  }
  return "";
}

ConfigNode parse_config(std::string_view text, const std::string& file_name) {
  check_text(text, file_name);
  TreeBuilder builder(file_name);
  try {
    std::istringstream stream{std::string(text) + kDocumentEnd};
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const ConfigError&) {
    refuse_unclosed(text, file_name);
    throw;
  } catch (const YAML::Exception& e) {
    refuse_unclosed(text, file_name);
    const int line = e.mark.is_null() ? 0 : e.mark.line + 1;
    const std::string_view before = from_line(text, line - 1);
    const std::string_view there = before.substr(0, before.size() - from_line(text, line + 1).size());
    throw ConfigError(file_name, line, "", "is not valid YAML: " + e.msg + typography_in(there));
  } catch (const std::exception& e) {
    throw ConfigError(file_name, 0, "", std::string("cannot be read: ") + e.what());
  }
  auto tree = std::make_shared<ConfigNode::Tree>();
  tree->file = file_name;
  tree->root = builder.take_root();
  if (!tree->root || tree->root->kind == NodeKind::kNull)
    throw ConfigError(file_name, 0, "", "is empty, must be a YAML map");
  if (tree->root->kind != NodeKind::kMap) {
    throw ConfigError(
        file_name, tree->root->line, "",
        "is " + tree->root->describe() + ", must be a YAML map" + typography_in(tree->root->scalar));
  }
  ConfigNode::Value* const root = tree->root.get();
  return {std::move(tree), root};
}

ConfigNode load_config(const std::string& path) {
  return parse_config(read_text_file(path, kMaxBytes), path);
}

}  // namespace swiftlet::io
