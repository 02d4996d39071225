#include "swiftlet/io/missions/mission_format.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/missions/motion_columns.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"

namespace swiftlet::ground {
namespace {

constexpr const char* kKnown =
    "duration,x^0,... (polynomials), t,x,y,z,... (samples) or x,y,z[,yaw] (waypoints, also without a "
    "header); x may be x_ned [m]";

std::string lower_case_extension(const std::string& file_name) {
  std::string extension = std::filesystem::path(file_name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

}  // namespace

MissionFormat detect_format(std::string_view text, const std::string& file_name) {
  const std::string extension = lower_case_extension(file_name);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool json = first != std::string_view::npos && text[first] == '{';
  if (extension == ".plan" || json) return MissionFormat::kQGroundControlPlan;
  if (extension == ".yaml" || extension == ".yml") return MissionFormat::kYaml;

  const std::vector<std::string> fields = runtime::first_csv_line(text, file_name);
  if (!fields.empty()) {
    if (fields.front() == "duration") return MissionFormat::kPolynomialCsv;
    const auto has = [&](const char* name) {
      return std::any_of(fields.begin(), fields.end(),
                         [&](const std::string& field) { return motion_name(field) == name; });
    };
    if (has("t")) return MissionFormat::kSampledCsv;
    const bool numbers = std::all_of(fields.begin(), fields.end(),
                                     [](const std::string& field) { return runtime::is_number(field); });
    if ((has("x") && has("y")) || (numbers && (fields.size() == 3 || fields.size() == 4)))
      return MissionFormat::kWaypointCsv;
  }
  if (extension != ".csv") return MissionFormat::kYaml;
  if (fields.empty())
    throw runtime::ConfigError(file_name, 0, "", std::string("is empty, must hold ") + kKnown);
  throw runtime::ConfigError(file_name, 1, "",
                             "has " + std::to_string(fields.size()) + " fields, of which the first is " +
                                 fields.front().substr(0, 40) + "; must begin with " + kKnown);
}

MissionFile parse_polynomial_csv(const std::string& text, const std::string& file_name,
                                 const control::Limits& limits, const FileOptions& options) {
  return whole_flight(file_name, read_polynomial_csv(text, file_name, limits, options), limits);
}

MissionFile parse_sampled_csv(const std::string& text, const std::string& file_name,
                              const control::Limits& limits, const FileOptions& options) {
  return whole_flight(file_name, read_sampled_csv(text, file_name, limits, options), limits);
}

MissionFile parse_waypoint_csv(const std::string& text, const std::string& file_name,
                               const control::Limits& limits, const FileOptions& options) {
  return whole_flight(file_name, read_waypoint_csv(text, file_name, limits, options), limits);
}

}  // namespace swiftlet::ground
