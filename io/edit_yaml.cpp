#include "swiftlet/io/edit_yaml.hpp"

#include <algorithm>
#include <cstddef>
#include <sstream>
#include <string_view>

#include <yaml-cpp/yaml.h>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::io {
namespace {

struct Replacement {
  std::string key;
  std::size_t begin = 0;
  std::size_t length = 0;
  std::string value;
};

// The steps of "attitude.roll.q[0]": attitude, roll, q, [0].
std::vector<std::string> steps_of(const std::string& key) {
  std::vector<std::string> steps;
  std::istringstream in(key);
  for (std::string step; std::getline(in, step, '.');) {
    const std::size_t bracket = step.find('[');
    steps.push_back(step.substr(0, bracket));
    if (bracket != std::string::npos) steps.push_back(step.substr(bracket));
  }
  return steps;
}

YAML::Node find(const YAML::Node& root, const std::string& key, const std::string& file_name) {
  YAML::Node node = root;
  for (const std::string& step : steps_of(key)) {
    const bool is_index = step.front() == '[';
    if (is_index ? !node.IsSequence() : !node.IsMap())
      throw ConfigError(file_name + ": " + key + " is missing");
    node.reset(is_index ? node[static_cast<std::size_t>(std::stoul(step.substr(1)))] : node[step]);
    if (!node.IsDefined()) throw ConfigError(file_name + ": " + key + " is missing");
  }
  if (!node.IsScalar()) throw ConfigError(file_name + ": " + key + " is no single value");
  return node;
}

// The length of the scalar at the start of the text.
std::size_t scalar_length(std::string_view text) {
  const char first = text.front();
  if (first == '"' || first == '\'') return text.find(first, 1) + 1;
  std::size_t end = text.find_first_of(",]}\n");
  end = std::min({end, text.find(" #"), text.find("\t#"), text.size()});
  while (end > 0 && (text[end - 1] == ' ' || text[end - 1] == '\t')) --end;
  return end;
}

}  // namespace

std::string with_scalars(const std::string& text, const std::string& file_name,
                         const std::vector<std::pair<std::string, std::string>>& values) {
  YAML::Node root;
  try {
    root = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw ConfigError(file_name + ": " + error.msg);
  }
  std::vector<Replacement> replacements;
  for (const auto& [key, value] : values) {
    const auto begin = static_cast<std::size_t>(find(root, key, file_name).Mark().pos);
    replacements.push_back({key, begin, scalar_length(std::string_view(text).substr(begin)), value});
  }
  std::sort(replacements.begin(), replacements.end(),
            [](const Replacement& a, const Replacement& b) { return a.begin > b.begin; });
  const auto same =
      std::adjacent_find(replacements.begin(), replacements.end(),
                         [](const Replacement& a, const Replacement& b) { return a.begin == b.begin; });
  if (same != replacements.end())
    throw ConfigError(file_name + ": " + same->key +
                      " shares its value with another key by an alias: write both out");
  std::string out = text;
  for (const Replacement& one : replacements) out.replace(one.begin, one.length, one.value);
  return out;
}

}  // namespace swiftlet::io
