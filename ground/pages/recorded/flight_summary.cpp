// The table at the top of the page.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/ground/pages/recorded/flight_topics.hpp"

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

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
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

double quantile99(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  const auto at = static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  return sorted[static_cast<std::size_t>(at)];
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
std::string saturation(const FlightTopics& topics) {
  std::size_t running = 0;
  std::size_t saturated = 0;
  for (std::size_t i = 0; i < topics.command.rows(); ++i) {
    if (topics.command.number("rotor_state", i) == 0.0) continue;
    ++running;
    bool limited = false;
    for (int k = 0; k < topics.command.number("rotor_count", i); ++k) {
      const double throttle = topics.command.number("throttle[" + std::to_string(k) + "]", i);
      limited = limited || throttle <= 0.0 || throttle >= 1.0;
    }
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

std::string poses(const FlightTopics& topics) {
  if (topics.estimate.rows() == 0) return kMissing;
  const std::size_t last = topics.estimate.rows() - 1;
  return fmt::format(
      "{:.0f} of {:.0f}", topics.estimate.number("poses_refused", last),
      topics.estimate.number("poses_refused", last) + topics.estimate.number("poses_accepted", last));
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
  for (const mcap::Metadata& metadata : file.metadata()) {
    const auto lost = metadata.values.find("lost");
    const auto dropped = metadata.values.find("dropped");
    if (metadata.name == "swiftlet/counts" && lost != metadata.values.end() &&
        dropped != metadata.values.end())
      return lost->second + " lost, " + dropped->second + " dropped";
  }
  return "not counted: the recorder was killed";
}

}  // namespace

void add_summary(const mcap::Reader& file, const FlightTopics& topics, FlightLog& flight) {
  auto& rows = flight.summary;
  const std::size_t infos = topics.vehicle.rows();
  const std::vector<double> latency = values_of(flight, "latency", "imu_to_command");
  rows.emplace_back("vehicle",
                    flight.vehicle + (infos == 0 ? "" : ", " + topics.vehicle.text("name", infos - 1)));
  for (const mcap::Metadata& metadata : file.metadata()) {
    if (metadata.name != "swiftlet/flight") continue;
    for (const char* const key : {"missions", "control", "simulation", "clock", "seed"}) {
      const auto found = metadata.values.find(key);
      if (found != metadata.values.end()) rows.emplace_back(key, found->second);
    }
  }
  rows.emplace_back("recorded", fmt::format("{:.1f} s", flight.end_s - flight.start_s));
  rows.emplace_back("in flight", fmt::format("{:.1f} s", flying_time_s(flight)));
  rows.emplace_back("position from", flight.has_truth ? "ground truth" : "estimate");
  rows.emplace_back("error 3-D, RMS", number(values_of(flight, "reference", "error_3d"), rms, "mm", 2));
  rows.emplace_back("error 3-D, peak", number(values_of(flight, "reference", "error_3d"), largest, "mm", 2));
  rows.emplace_back("top speed", number(values_of(flight, "path", "speed"), largest, "m/s", 2));
  rows.emplace_back("battery", battery(flight));
  rows.emplace_back("rotors at a limit", saturation(topics));
  rows.emplace_back("poses refused", poses(topics));
  rows.emplace_back("position estimate within 3 σ",
                    within_bounds(flight, "estimate", "deviation_", {"north", "east", "down"}));
  rows.emplace_back("position innovation within 3 σ",
                    within_bounds(flight, "innovation", "", {"north", "east", "down"}));
  rows.emplace_back("IMU to command, p99", number(latency, quantile99, "µs", 0));
  rows.emplace_back("messages", counts(file));
}

}  // namespace swiftlet::pages
