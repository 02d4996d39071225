#include "swiftlet/io/missions/waypoint_list.hpp"

#include <sstream>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"

namespace swiftlet::io {
namespace {

constexpr std::string_view kBegin = "QGC WPL ";
constexpr std::size_t kFields = 12;
constexpr std::size_t kFrame = 2, kCommand = 3, kFirstParameter = 4;

}  // namespace

bool is_waypoint_list(std::string_view text) { return text.substr(0, kBegin.size()) == kBegin; }

std::string plan_of_waypoint_list(const std::string& text, const std::string& file_name) {
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  if (line.find("110") == std::string::npos)
    throw io::ConfigError(file_name, 1, "", "is " + line.substr(0, 40) + ", must be QGC WPL 110");
  std::string plan = "{\"fileType\": \"Plan\", \"mission\": {";
  std::string before = "\"items\": [";
  bool home = true;
  for (int number = 2; std::getline(in, line); ++number) {
    plan += '\n';
    std::istringstream fields(line);
    std::vector<std::string> row;
    for (std::string field; fields >> field;) row.push_back(field);
    if (row.empty()) continue;
    if (row.size() != kFields)
      throw io::ConfigError(file_name, number, "",
                            fmt::format("has {} fields, must have {}", row.size(), kFields));
    std::string parameters;
    for (std::size_t i = 0; i < kFields; ++i) {
      const auto value = io::parse_number(row[i]);
      if (!value)
        throw io::ConfigError(file_name, number, fmt::format("field {}", i + 1),
                              "is " + row[i].substr(0, 40) + ", must be a finite number");
      if (i >= kFirstParameter && i + 1 < kFields)
        parameters += (parameters.empty() ? "" : ", ") + io::exact(*value);
    }
    if (home && row[kFrame] == "0") {  // latitude, longitude, altitude
      std::string::size_type at = 0;
      for (int skipped = 0; skipped < 4; ++skipped) at = parameters.find(", ", at) + 2;
      plan += "\"plannedHomePosition\": [" + parameters.substr(at) + "],";
    } else {
      plan += before + "{\"type\": \"SimpleItem\", \"command\": " + row[kCommand] +
              ", \"frame\": " + row[kFrame] + ", \"params\": [" + parameters + "]}";
      before = ", ";
    }
    home = false;
  }
  if (before != ", ") plan += before;
  return plan + "]}}\n";
}

}  // namespace swiftlet::io
