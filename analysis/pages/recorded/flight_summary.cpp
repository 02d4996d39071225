// The table at the top of the page.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/analysis/pages/recorded/flight_pieces.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/record/evaluation.hpp"
#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/record/file/message_file.hpp"

namespace swiftlet::pages {
namespace {

constexpr const char* kMissing = "–";

// The finite values of a signal.
std::vector<double> values_of(const FlightLog& flight, const char* table, const std::string& signal) {
  std::vector<double> values;
  const auto found = flight.tables.find(table);
  if (found == flight.tables.end()) return values;
  const auto column = found->second.signals.find(signal);
  if (column == found->second.signals.end()) return values;
  std::copy_if(column->second.begin(), column->second.end(), std::back_inserter(values),
               [](double value) { return std::isfinite(value); });
  return values;
}

double largest(const std::vector<double>& values) {
  double peak = 0.0;
  for (const double value : values) peak = std::max(peak, std::abs(value));
  return peak;
}

std::string number(const std::vector<double>& values, double (*figure)(const std::vector<double>&),
                   const char* unit, int decimals) {
  return values.empty() ? kMissing : fmt::format("{:.{}f} {}", figure(values), decimals, unit);
}

double flying_time_s(const FlightLog& flight) {
  double sum = 0.0;
  for (std::size_t i = 0; i < flight.modes.size(); ++i) {
    const std::string& mode = flight.modes[i].mode;
    const double end_s = i + 1 < flight.modes.size() ? flight.modes[i + 1].time_s : flight.end_s;
    if (mode != "disarmed" && mode != "armed" && mode != "stopped") sum += end_s - flight.modes[i].time_s;
  }
  return sum;
}

// The share of the commands with running rotors in which a rotor is at its limit.
std::string saturation(const record::Flight& recorded) {
  std::size_t running = 0;
  std::size_t saturated = 0;
  for (const plant::ActuatorCommand& command : recorded.commands) {
    if (command.rotor_state == plant::RotorState::kOff) continue;
    ++running;
    const auto end = command.throttle.begin() + command.rotor_count;
    const bool limited = std::any_of(command.throttle.begin(), end,
                                     [](double throttle) { return throttle <= 0.0 || throttle >= 1.0; });
    saturated += limited ? 1 : 0;
  }
  if (running == 0) return kMissing;
  return fmt::format("{:.2f} % of {} commands",
                     100.0 * static_cast<double>(saturated) / static_cast<double>(running), running);
}

std::string battery(const FlightLog& flight) {
  const std::vector<double> voltage = values_of(flight, "battery", "voltage");
  if (voltage.empty()) return kMissing;
  return fmt::format("{:.2f} V to {:.2f} V, least {:.2f} V", voltage.front(), voltage.back(),
                     *std::min_element(voltage.begin(), voltage.end()));
}

std::string poses(const record::Flight& recorded) {
  if (recorded.estimate.empty()) return kMissing;
  const record::EstimateRow& last = recorded.estimate.back();
  return fmt::format("{:.0f} of {:.0f}", last.poses_refused, last.poses_refused + last.poses_accepted);
}

// The share of the samples of a deviation within its bound, over all axes.
std::string within_bounds(const FlightLog& flight, const char* table, const char* prefix,
                          const std::vector<const char*>& axes) {
  const auto found = flight.tables.find(table);
  if (found == flight.tables.end()) return kMissing;
  std::size_t inside = 0;
  std::size_t count = 0;
  for (const char* const axis : axes) {
    const auto value = found->second.signals.find(std::string(prefix) + axis);
    const auto bound = found->second.signals.find(std::string("bound_") + axis);
    if (value == found->second.signals.end() || bound == found->second.signals.end()) continue;
    for (std::size_t i = 0; i < value->second.size(); ++i) {
      if (!std::isfinite(value->second[i])) continue;
      ++count;
      inside += std::abs(value->second[i]) <= bound->second[i] ? 1 : 0;
    }
  }
  return count == 0
             ? kMissing
             : fmt::format("{:.1f} %", 100.0 * static_cast<double>(inside) / static_cast<double>(count));
}

std::string counts(const mcap::Reader& file) {
  const auto counted = record::metadata_of(file, record::kCountsMetadata);
  const auto lost = counted.find("lost");
  const auto dropped = counted.find("dropped");
  if (lost == counted.end() || dropped == counted.end()) return "not counted: the recorder was killed";
  return lost->second + " lost, " + dropped->second + " dropped";
}

std::string millimetres(const record::TrackingErrors& errors, double metres) {
  return errors.matched == 0 ? kMissing : fmt::format("{:.2f} mm", 1e3 * metres);
}

using Metadata = std::map<std::string, std::string>;

std::string value_of(const Metadata& metadata, const std::string& key) {
  const auto found = metadata.find(key);
  return found == metadata.end() ? "" : found->second;
}

// The value of this vehicle in a list with one for each vehicle.
std::string own(const Metadata& metadata, const std::string& key, const std::string& vehicle) {
  const std::vector<std::string> vehicles = io::split_text(value_of(metadata, "vehicles"), ',');
  const std::vector<std::string> values = io::split_text(value_of(metadata, key), ',');
  const auto at =
      static_cast<std::size_t>(std::find(vehicles.begin(), vehicles.end(), vehicle) - vehicles.begin());
  return at < values.size() && vehicles.size() == values.size() ? values[at] : value_of(metadata, key);
}

void add_setting(std::vector<std::pair<std::string, std::string>>& rows, const char* label,
                 const std::string& value) {
  if (!value.empty()) rows.emplace_back(label, value);
}

// As the vehicle measured it, which the summary of a flight shows too.
std::string sense_to_actuate(const record::Flight& recorded) {
  if (recorded.vehicle.empty() || !(recorded.vehicle.back().sense_to_actuate_p99_us > 0.0)) return kMissing;
  const record::VehicleRow& last = recorded.vehicle.back();
  return fmt::format("{:.0f} / {:.0f} µs", last.sense_to_actuate_p50_us, last.sense_to_actuate_p99_us);
}

}  // namespace

void add_summary(const mcap::Reader& file, const record::Flight& recorded,
                 const record::TrackingErrors& errors, FlightLog& flight) {
  auto& rows = flight.summary;
  rows.emplace_back("vehicle",
                    flight.vehicle + (recorded.vehicle.empty() ? "" : ", " + recorded.vehicle.back().name));
  const auto metadata = record::metadata_of(file, "swiftlet/flight");
  add_setting(rows, "mission", own(metadata, "missions", flight.vehicle));
  for (const char* const key : {"control", "simulation", "clock"})
    add_setting(rows, key, value_of(metadata, key));
  const std::string seed = own(metadata, "seeds", flight.vehicle);
  add_setting(rows, "seed", seed.empty() ? value_of(metadata, "seed") : seed);
  rows.emplace_back("recorded", fmt::format("{:.1f} s", flight.end_s - flight.start_s));
  rows.emplace_back("in flight", fmt::format("{:.1f} s", flying_time_s(flight)));
  rows.emplace_back("position from", flight.has_truth ? "ground truth" : "estimate");
  rows.emplace_back("errors against", record::to_string(errors.against));
  rows.emplace_back("error 3-D, RMS", millimetres(errors, errors.rms_3d_m));
  rows.emplace_back("error 3-D, peak", millimetres(errors, errors.peak_3d_m));
  rows.emplace_back("top speed", number(values_of(flight, "path", "speed"), largest, "m/s", 2));
  rows.emplace_back("battery", battery(flight));
  rows.emplace_back("rotors at a limit", saturation(recorded));
  rows.emplace_back("poses refused", poses(recorded));
  rows.emplace_back("position estimate within 3 σ",
                    within_bounds(flight, "estimate", "deviation_", {"north", "east", "down"}));
  rows.emplace_back("position innovation within 3 σ",
                    within_bounds(flight, "innovation", "", {"north", "east", "down"}));
  rows.emplace_back("sense to actuate, p50 / p99",
                    flight.wall_start_s > 0.0 ? sense_to_actuate(recorded) : kMissing);
  rows.emplace_back("messages", counts(file));
}

}  // namespace swiftlet::pages
