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
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string kind : kKinds) {
    const fs::path file = folder / (kind + ".yaml");
    if (!fs::exists(file)) continue;
    for (auto& [key, value] : runtime::flatten_yaml(runtime::read_text_file(file.string()), file.string()))
      all.emplace_back(kind + "." + key, std::move(value));
  }
  return all;
}

}  // namespace swiftlet::ground
