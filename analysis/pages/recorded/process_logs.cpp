#include "swiftlet/analysis/pages/recorded/process_logs.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/math/time.hpp"
#include "swiftlet/record/file/process_log.hpp"

namespace swiftlet::pages {
namespace {

constexpr double kAround_s = 10.0;  // before the first message and after the last

// A process that serves several vehicles begins a line with the name of one, if it is about that: "kl2: rotors started".
std::string vehicle_of(const std::string& text, const std::vector<std::string>& vehicles) {
  const std::string name = text.substr(0, text.find(": "));
  return std::find(vehicles.begin(), vehicles.end(), name) == vehicles.end() ? "" : name;
}

}  // namespace

void add_process_logs(const std::filesystem::path& folder, const std::vector<std::string>& vehicles,
                      FlightLog& flight) {
  if (flight.wall_start_s == 0.0) return;
  const auto zero_ns = static_cast<std::int64_t>(std::llround(flight.wall_start_s * math::kNsPerS));
  for (const record::ProcessLogLine& line : record::process_log_lines(folder, zero_ns)) {
    const double time_s = static_cast<double>(line.time_ns - zero_ns) / math::kNsPerS;
    if (time_s < flight.start_s - kAround_s || time_s > flight.end_s + kAround_s) continue;
    const std::string vehicle = vehicle_of(line.text, vehicles);
    if (!vehicle.empty() && vehicle != flight.vehicle) continue;
    const bool warning = line.level != "info" && line.level != "debug";
    flight.events.push_back({time_s, "log", line.process + " " + line.level + ": " + line.text, warning});
  }
  std::stable_sort(flight.events.begin(), flight.events.end(),
                   [](const FlightEvent& a, const FlightEvent& b) { return a.time_s < b.time_s; });
}

}  // namespace swiftlet::pages
