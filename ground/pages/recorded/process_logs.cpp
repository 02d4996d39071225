#include "swiftlet/ground/pages/recorded/process_logs.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "swiftlet/io/text_file.hpp"

namespace swiftlet::pages {
namespace {

namespace fs = std::filesystem;

constexpr double kDay_s = 86400.0;
constexpr double kHour_s = 3600.0;
constexpr double kMinute_s = 60.0;
constexpr double kAround_s = 10.0;  // before the first message and after the last

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

double time_of_day_s(double wall_s) {
  const auto seconds = static_cast<std::time_t>(std::floor(wall_s));
  std::tm local{};
  ::localtime_r(&seconds, &local);
  return kHour_s * local.tm_hour + kMinute_s * local.tm_min + local.tm_sec + wall_s - std::floor(wall_s);
}

// "15:04:27.033 control info: plant joined", at the time that is nearest to the start of the flight.
std::optional<FlightEvent> event_of(const std::string& line, double start_of_day_s) {
  static const std::regex form(R"((\d\d):(\d\d):(\d\d\.\d+) (\S+ )(\w+)(: .*))");
  std::smatch part;
  if (!std::regex_match(line, part, form)) return std::nullopt;
  const double day_s =
      kHour_s * std::stod(part[1]) + kMinute_s * std::stod(part[2]) + std::stod(part[3]) - start_of_day_s;
  const std::string level = part[5];
  const std::string text = part[4].str() + level + part[6].str();
  return FlightEvent{std::remainder(day_s, kDay_s), "log", text, level != "info" && level != "debug"};
}

}  // namespace

void add_process_logs(const fs::path& folder, FlightLog& flight) {
  if (flight.wall_start_s == 0.0) return;
  const double start_of_day_s = time_of_day_s(flight.wall_start_s);
  for (const fs::path& log : logs_in(folder)) {
    std::istringstream lines(runtime::read_text_file(log.string()));
    for (std::string line; std::getline(lines, line);) {
      std::optional<FlightEvent> event = event_of(line, start_of_day_s);
      if (event && event->time_s > flight.start_s - kAround_s && event->time_s < flight.end_s + kAround_s)
        flight.events.push_back(std::move(*event));
    }
  }
  std::stable_sort(flight.events.begin(), flight.events.end(),
                   [](const FlightEvent& a, const FlightEvent& b) { return a.time_s < b.time_s; });
}

}  // namespace swiftlet::pages
