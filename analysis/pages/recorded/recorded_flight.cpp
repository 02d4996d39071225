#include "swiftlet/analysis/pages/recorded/recorded_flight.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/analysis/pages/recorded/flight_pieces.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/flat_yaml.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/record/mcap/attached_file.hpp"

namespace swiftlet::pages {
namespace {

void set_range(FlightLog& flight) {
  flight.start_s = std::numeric_limits<double>::max();
  flight.end_s = std::numeric_limits<double>::lowest();
  for (const auto& [name, table] : flight.tables) {
    if (table.time_s.empty()) continue;
    flight.start_s = std::min(flight.start_s, table.time_s.front());
    flight.end_s = std::max(flight.end_s, table.time_s.back());
  }
}

// The start of the first mission; without one the take-off, or what was recorded first.
std::int64_t zero_of(const record::Flight& recorded, const record::Evaluation& flown) {
  if (flown.mission_id != 0 && flown.window) return flown.window->from_ns;
  const auto flying = std::find_if(recorded.status.begin(), recorded.status.end(),
                                   [](const record::StatusRow& row) { return is_flying(row.mode); });
  if (flying != recorded.status.end()) return flying->stamp_ns;
  return recorded.estimate.empty() ? recorded.truth.front().stamp_ns : recorded.estimate.front().stamp_ns;
}

// The deviation in the control settings that the recorder attaches.
PoseDeviation pose_deviation(const mcap::Reader& file, const std::string& vehicle) {
  PoseDeviation deviation;
  const std::optional<std::string> settings = mcap::attached_file(file, vehicle, "control.yaml");
  if (!settings) return deviation;
  for (const auto& [key, value] : io::flatten_yaml(*settings, file.name() + "/control.yaml")) {
    if (key == "estimator.mocap_position_m") deviation.position_m = io::parse_number(value).value_or(0.0);
    if (key == "estimator.mocap_orientation_rad")
      deviation.rotation_rad = io::parse_number(value).value_or(0.0);
  }
  return deviation;
}

}  // namespace

FlightLog flight_log(const mcap::Reader& file, const std::string& vehicle, const record::Flight& recorded,
                     const std::string& name) {
  if (recorded.truth.empty() && recorded.estimate.empty())
    throw io::ConfigError(file.name(), 0, vehicle, "holds no flight: has neither estimate nor ground_truth");
  const auto recorder = record::metadata_of(file, "swiftlet/recorder");
  const auto time = recorder.find("time");
  const record::Evaluation flown = record::evaluate(recorded);
  const RecordedClock clock{zero_of(recorded, flown), time != recorder.end() && time->second == "vehicle"};
  FlightLog flight;
  flight.name = name;
  flight.vehicle = vehicle;
  flight.has_truth = !recorded.truth.empty();
  if (!clock.simulated_time)
    flight.wall_start_s = static_cast<double>(clock.zero_ns + recorded.log_minus_stamp_ns) / math::kNsPerS;
  add_signals(recorded, clock, pose_deviation(file, vehicle), flight);
  add_events(recorded, clock, flight);
  set_range(flight);
  add_summary(file, recorded, flown.errors, flight);
  return flight;
}

}  // namespace swiftlet::pages
