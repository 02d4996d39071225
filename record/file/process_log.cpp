#include "swiftlet/record/file/process_log.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <optional>
#include <sstream>
#include <system_error>

#include "swiftlet/io/text_file.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/record/file/event_log.hpp"

namespace swiftlet::record {
namespace {

namespace fs = std::filesystem;

constexpr double kDay_s = 86400.0;
constexpr double kHour_s = 3600.0;
constexpr double kMinute_s = 60.0;

std::vector<fs::path> logs_in(const fs::path& folder) {
  std::vector<fs::path> logs;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename();
    if (name.rfind("swiftlet-", 0) == 0 && entry.path().extension() == ".log") logs.push_back(entry.path());
  }
  std::sort(logs.begin(), logs.end());
  return logs;
}

double time_of_day_s(std::int64_t time_ns) {
  const double time_s = static_cast<double>(time_ns) / math::kNsPerS;
  const auto seconds = static_cast<std::time_t>(std::floor(time_s));
  std::tm local{};
  ::localtime_r(&seconds, &local);
  return kHour_s * local.tm_hour + kMinute_s * local.tm_min + local.tm_sec + time_s - std::floor(time_s);
}

// "15:04:27.033 control info: plant joined"
std::optional<ProcessLogLine> line_in(const std::string& text, std::int64_t near_ns) {
  int hours = 0, minutes = 0, end = 0;
  double seconds = 0.0;
  char process[64] = {}, level[16] = {};
  if (std::sscanf(text.c_str(), "%2d:%2d:%lf %63s %15[a-z]:%n", &hours, &minutes, &seconds, process, level,
                  &end) != 5)
    return std::nullopt;
  const bool is_time =
      hours >= 0 && minutes >= 0 && seconds >= 0.0 && seconds <= kMinute_s;  // not NaN either
  const auto colon = static_cast<std::size_t>(end);
  if (!is_time || end == 0 || text.compare(colon, 1, " ") != 0) return std::nullopt;
  const double of_day_s = kHour_s * hours + kMinute_s * minutes + seconds;
  const double later_s = std::remainder(of_day_s - time_of_day_s(near_ns), kDay_s);
  return ProcessLogLine{near_ns + static_cast<std::int64_t>(std::llround(later_s * math::kNsPerS)), process,
                        level, text.substr(colon + 1)};
}

LogLevel level_of(const std::string& name) {
  if (name == "critical") return LogLevel::kFatal;
  if (name == "error") return LogLevel::kError;
  if (name == "warning") return LogLevel::kWarning;
  if (name == "info") return LogLevel::kInfo;
  return LogLevel::kDebug;
}

}  // namespace

std::vector<ProcessLogLine> process_log_lines(const fs::path& folder, std::int64_t near_ns) {
  std::vector<ProcessLogLine> lines;
  for (const fs::path& log : logs_in(folder)) {
    std::istringstream texts(io::read_text_file(log.string()));
    for (std::string text; std::getline(texts, text);) {
      if (auto line = line_in(text, near_ns)) lines.push_back(std::move(*line));
    }
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const ProcessLogLine& a, const ProcessLogLine& b) { return a.time_ns < b.time_ns; });
  return lines;
}

StandardMessage log_message(const ProcessLogLine& line) {
  return log_message("/log", line.time_ns, level_of(line.level), line.process, line.text);
}

}  // namespace swiftlet::record
