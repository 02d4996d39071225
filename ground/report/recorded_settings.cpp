#include "swiftlet/ground/report/recorded_settings.hpp"

#include <array>

#include "swiftlet/io/flat_yaml.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;

constexpr std::array kKinds = {"control", "mission", "simulation", "vehicle"};

}  // namespace

std::vector<std::pair<std::string, std::string>> recorded_settings(const fs::path& folder) {
  std::map<std::string, std::string> texts;
  for (const std::string kind : kKinds) {
    const fs::path file = folder / (kind + ".yaml");
    if (fs::exists(file)) texts[kind + ".yaml"] = runtime::read_text_file(file.string());
  }
  return recorded_settings(folder.string(), texts);
}

std::vector<std::pair<std::string, std::string>> recorded_settings(
    const std::string& source, const std::map<std::string, std::string>& texts) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string kind : kKinds) {
    const auto text = texts.find(kind + ".yaml");
    if (text == texts.end()) continue;
    for (auto& [key, value] : runtime::flatten_yaml(text->second, source + "/" + text->first))
      all.emplace_back(kind + "." + key, std::move(value));
  }
  return all;
}

}  // namespace swiftlet::ground
