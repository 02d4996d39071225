#include "swiftlet/io/missions/mission_format.hpp"

#include <filesystem>

#include "swiftlet/io/missions/crazyflie_log.hpp"
#include "swiftlet/io/missions/motive_take.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {
namespace {

constexpr const char* kKnownFormats =
    "duration,x^0,... (polynomials), t,x,y,z,... (samples) or x,y,z[,yaw] (waypoints, also without a "
    "header); x may be x_ned [m]";

void take(Source& source, MissionTable read) {
  source.format = format_of(read.table.columns());
  source.table = std::move(read.table);
  source.assumptions = std::move(read.assumptions);
}

[[noreturn]] void refuse_unknown(const Table& table) {
  if (table.column_count() == 0)
    throw ConfigError(table.file(), 0, "", std::string("is empty, must hold ") + kKnownFormats);
  throw ConfigError(table.file(), 1, "",
                    "has " + std::to_string(table.column_count()) + " fields, of which the first is " +
                        table.column(0).substr(0, 40) + "; must begin with " + kKnownFormats);
}

void refuse_other_options(const Source& source, const std::string& file, const FileOptions& options) {
  const auto refuse = [&](const char* message) { throw ConfigError(file, 0, "", message); };
  if (options.frame && source.plan) refuse("names the frame of each item itself: --frame is for other files");
  if (!options.columns.empty() && !source.table) refuse("is no table: --columns is for CSV files");
  if (source.format == MissionFormat::kSampledCsv) return;
  if (options.tolerance_m) refuse("is no table of samples: --tolerance is for those");
  if (options.from_s || options.until_s) refuse("is no table of samples: --from and --until are for those");
}

}  // namespace

Source parse_source(const std::string& text, const std::string& file_name, const FileOptions& options) {
  const std::string extension = lower(std::filesystem::path(file_name).extension().string());
  const std::string_view content = trimmed(text, " \t\r\n\xef\xbb\xbf");  // also without a byte order mark
  Source source;
  const bool is_log = is_crazyflie_log(text);
  if (is_log || is_motive_take(content)) {
    if (!options.columns.empty())
      throw ConfigError(file_name, 0, "", "names its columns itself: --columns is for other CSV files");
    take(source,
         is_log ? read_crazyflie_log(text, file_name) : read_motive_take(text, file_name, options.frame));
  } else if (is_waypoint_list(content)) {
    source.plan = plan_of_waypoint_list(text, file_name);
    source.assumptions.emplace_back("a list of waypoints, read like a plan of QGroundControl");
  } else if (extension == ".plan" || (!content.empty() && content.front() == '{')) {
    source.plan = plan_of_json(text, file_name);
  } else if (extension != ".yaml" && extension != ".yml") {
    take(source, read_mission_table(text, file_name, options.columns));
    if (source.format == MissionFormat::kYaml && extension == ".csv") refuse_unknown(*source.table);
  }
  if (source.plan) source.format = MissionFormat::kQGroundControlPlan;
  if (source.format == MissionFormat::kYaml) {
    source = {};
    source.text = text;
  }
  refuse_other_options(source, file_name, options);
  return source;
}

Source read_source(const std::string& path, const FileOptions& options) {
  return parse_source(read_text_file(path), path, options);
}

std::optional<TrajectoryFile> path_of(const Source& source, const control::Limits& limits,
                                      const FileOptions& options) {
  if (!source.table) return std::nullopt;
  const auto read = source.format == MissionFormat::kPolynomialCsv ? read_polynomials
                    : source.format == MissionFormat::kSampledCsv  ? read_samples
                                                                   : read_waypoints;
  TrajectoryFile path = read(*source.table, limits, options);
  path.assumptions.insert(path.assumptions.begin(), source.assumptions.begin(), source.assumptions.end());
  return path;
}

}  // namespace swiftlet::io
