#include "swiftlet/io/missions/mission_format.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/missions/crazyflie_log.hpp"
#include "swiftlet/io/missions/foreign_table.hpp"
#include "swiftlet/io/missions/motion_columns.hpp"
#include "swiftlet/io/missions/waypoint_list.hpp"
#include "swiftlet/io/missions/whole_flight.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {
namespace {

constexpr const char* kKnownFormats =
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

  const std::vector<std::string> fields = io::first_csv_line(text, file_name);
  if (!fields.empty()) {
    if (fields.front() == "duration") return MissionFormat::kPolynomialCsv;
    const auto has = [&](const char* name) {
      return std::any_of(fields.begin(), fields.end(),
                         [&](const std::string& field) { return motion_name(field) == name; });
    };
    if (has("t")) return MissionFormat::kSampledCsv;
    const bool numbers = std::all_of(fields.begin(), fields.end(),
                                     [](const std::string& field) { return io::is_number(field); });
    if ((has("x") && has("y")) || (numbers && (fields.size() == 3 || fields.size() == 4)))
      return MissionFormat::kWaypointCsv;
  }
  if (extension != ".csv") return MissionFormat::kYaml;
  if (fields.empty())
    throw io::ConfigError(file_name, 0, "", std::string("is empty, must hold ") + kKnownFormats);
  throw io::ConfigError(file_name, 1, "",
                        "has " + std::to_string(fields.size()) + " fields, of which the first is " +
                            fields.front().substr(0, 40) + "; must begin with " + kKnownFormats);
}

Source read_source(const std::string& path, const FileOptions& options) {
  Source source;
  source.text = io::read_text_file(path);
  const std::string extension = lower_case_extension(path);
  const std::size_t first = source.text.find_first_not_of(" \t\r\n");
  const bool json = first != std::string::npos && source.text[first] == '{';
  const bool log = is_crazyflie_log(source.text);
  if (log) {
    CrazyflieLog read = read_crazyflie_log(source.text, path);
    source.text = std::move(read.table);
    source.assumptions = std::move(read.assumptions);
    source.format = MissionFormat::kSampledCsv;
  } else if (is_waypoint_list(source.text)) {
    source.text = plan_of_waypoint_list(source.text, path);
    source.format = MissionFormat::kQGroundControlPlan;
    source.assumptions.emplace_back("a list of waypoints, read like a plan of QGroundControl");
  } else if (json || extension == ".plan" || extension == ".yaml" || extension == ".yml") {
    source.format = detect_format(source.text, path);
  } else {
    ForeignTable table = read_foreign_table(source.text, path, options.columns);
    source.text = std::move(table.text);
    source.first_line = table.first_line;
    source.assumptions = std::move(table.assumptions);
    source.format = detect_format(source.text, path);
  }
  const bool table =
      source.format != MissionFormat::kYaml && source.format != MissionFormat::kQGroundControlPlan;
  if (options.frame && source.format == MissionFormat::kQGroundControlPlan)
    throw io::ConfigError(path, 0, "", "names the frame of each item itself: --frame is for other files");
  if (!options.columns.empty() && (!table || log))
    throw io::ConfigError(path, 0, "", "is no table: --columns is for CSV files");
  if (options.tolerance_m && source.format != MissionFormat::kSampledCsv)
    throw io::ConfigError(path, 0, "", "is no table of samples: --tolerance is for those");
  if ((options.from_s || options.until_s) && source.format != MissionFormat::kSampledCsv)
    throw io::ConfigError(path, 0, "", "is no table of samples: --from and --until are for those");
  return source;
}

MissionFile parse_polynomial_csv(const std::string& text, const std::string& file_name,
                                 const control::Limits& limits, const FileOptions& options, int first_line) {
  return whole_flight(file_name, read_polynomial_csv(text, file_name, limits, options, first_line), limits);
}

MissionFile parse_sampled_csv(const std::string& text, const std::string& file_name,
                              const control::Limits& limits, const FileOptions& options, int first_line) {
  return whole_flight(file_name, read_sampled_csv(text, file_name, limits, options, first_line), limits);
}

MissionFile parse_waypoint_csv(const std::string& text, const std::string& file_name,
                               const control::Limits& limits, const FileOptions& options, int first_line) {
  return whole_flight(file_name, read_waypoint_csv(text, file_name, limits, options, first_line), limits);
}

}  // namespace swiftlet::io
