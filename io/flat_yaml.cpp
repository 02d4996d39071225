#include "swiftlet/io/flat_yaml.hpp"

#include <algorithm>

#include <yaml-cpp/yaml.h>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::io {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

bool is_plain_list(const YAML::Node& node) {
  return node.IsSequence() &&
         std::all_of(node.begin(), node.end(), [](const YAML::Node& entry) { return entry.IsScalar(); });
}

std::string plain_list(const YAML::Node& node) {
  std::string text;
  for (const YAML::Node& entry : node) text += (text.empty() ? "" : ", ") + entry.Scalar();
  return "[" + text + "]";
}

void flatten(const YAML::Node& node, const std::string& key, Settings& settings) {
  if (is_plain_list(node)) {
    settings.emplace_back(key, plain_list(node));
  } else if (node.IsMap()) {
    for (const auto& entry : node)
      flatten(entry.second, (key.empty() ? "" : key + ".") + entry.first.Scalar(), settings);
  } else if (node.IsSequence()) {
    for (std::size_t i = 0; i < node.size(); ++i)
      flatten(node[i], key + "[" + std::to_string(i) + "]", settings);
  } else {
    settings.emplace_back(key, node.IsScalar() ? node.Scalar() : "");
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> flatten_yaml(std::string_view text,
                                                              const std::string& file_name) {
  Settings settings;
  try {
    flatten(YAML::Load(std::string(text)), "", settings);
  } catch (const YAML::Exception& error) {
    throw ConfigError(file_name, error.mark.is_null() ? 0 : error.mark.line + 1, "",
                      "is not valid YAML: " + error.msg);
  }
  return settings;
}

}  // namespace swiftlet::io
