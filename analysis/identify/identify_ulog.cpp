#include "swiftlet/analysis/identify/identify_ulog.hpp"

#include <cstdio>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/identification/flight/thrust_scale.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/io/ulog/ulog.hpp"

namespace swiftlet::analysis {
namespace {

using identification::ThrottleRecord;
using identification::ThrustScale;

constexpr double kGroundMargin_s = 1.0;  // of the flight, at either end
constexpr double kNeededRate_hz = 100.0;
constexpr double k95 = 1.96;

double rate_of(const ulog::Table& table) {
  if (table.rows() < 2) return 0.0;
  return static_cast<double>(table.rows() - 1) / (table.time_s.back() - table.time_s.front());
}

// Why the parameters that other logs determine are not identified from this one.
std::string missing_of(const ulog::Log& log) {
  const std::string parameters = "rotors, motor lag, inertia, drag and delays";
  if (!log.has("actuator_motors")) return parameters + ": actuator_motors is not logged";
  const double rate_hz = rate_of(log.read("actuator_motors", {"control[0]"}));
  return fmt::format("{}: actuator_motors is logged at {:.0f} Hz, {:g} Hz are needed", parameters, rate_hz,
                     kNeededRate_hz);
}

// The longest time in the air.
std::pair<double, double> flight_of(const ulog::Table& land, double end_s) {
  std::pair<double, double> longest{0.0, 0.0};
  for (std::size_t i = 0; i < land.rows(); ++i) {
    if (land.columns[0][i] != 0.0) continue;
    const double from_s = land.time_s[i];
    while (i < land.rows() && land.columns[0][i] == 0.0) ++i;
    const double until_s = i < land.rows() ? land.time_s[i] : end_s;
    if (until_s - from_s > longest.second - longest.first) longest = {from_s, until_s};
  }
  return longest;
}

ThrottleRecord record_of(const ulog::Log& log, const IdentifyFlightOptions& options) {
  ThrottleRecord record;
  ulog::Table thrust = log.read("vehicle_thrust_setpoint", {"xyz[2]"});
  ulog::Table sensors = log.read("sensor_combined", {"accelerometer_m_s2[2]"});
  const ulog::Table land = log.read("vehicle_land_detected", {"landed"});
  for (double& value : thrust.columns[0]) value = -value;
  for (double& value : sensors.columns[0]) value = -value;
  const auto [from_s, until_s] = flight_of(land, sensors.rows() > 0 ? sensors.time_s.back() : 0.0);
  record.throttle_time_s = std::move(thrust.time_s);
  record.throttle = std::move(thrust.columns[0]);
  record.force_time_s = std::move(sensors.time_s);
  record.specific_force_up = std::move(sensors.columns[0]);
  if (log.has("battery_status")) {
    ulog::Table battery = log.read("battery_status", {"voltage_v"});
    record.voltage_time_s = std::move(battery.time_s);
    record.supply_voltage_v = std::move(battery.columns[0]);
  }
  record.from_s = options.fit.bounds.from_s.value_or(from_s + kGroundMargin_s);
  record.until_s = options.fit.bounds.until_s.value_or(until_s - kGroundMargin_s);
  return record;
}

struct Result {
  std::string log;
  ThrustScale scale;
  std::string missing;
  bool ends_early = false;
  std::vector<ulog::Loss> losses;
};

std::string text_of(const ulog::Loss& loss) {
  if (loss.bytes == 0)
    return fmt::format("PX4 could not log from {:.3f} s to {:.3f} s", loss.from_s, loss.until_s);
  return fmt::format("{} bytes at byte {} are no messages: nothing is read from {:.3f} s to {:.3f} s",
                     loss.bytes, loss.at, loss.from_s, loss.until_s);
}

std::string table_of(const Result& result, const plant::Vehicle& base, const std::string& base_name) {
  const ThrustScale& scale = result.scale;
  std::string text =
      fmt::format("{}: thrust scale of PX4, from {:.0f} s of flight, mass {:g} kg of {}\n", result.log,
                  0.1 * static_cast<double>(scale.blocks), base.mass_kg, base_name);
  text += fmt::format(
      "  throttle of hover   {:.4f} +- {:.4f}   MPC_THR_HOVER, and --hover-throttle of swiftlet-px4\n",
      scale.hover_throttle, k95 * scale.hover_deviation);
  if (scale.slope_known) {
    text += fmt::format("  slope at hover      {:.3f} +- {:.3f} N   thrust for each 1 of throttle\n",
                        scale.slope_n, k95 * scale.slope_deviation);
  } else {
    text += fmt::format("  slope at hover      not identifiable: the throttle was {:.3f} to {:.3f}\n",
                        scale.least_throttle, scale.greatest_throttle);
  }
  text += fmt::format("  residual            {:.4f} N, root mean square\n", scale.residual_n);
  text += fmt::format(
      "  vehicle file        {:.4f} for the weight at {}: {:.3f} times that; slope {:.3f} N\n",
      scale.curve_throttle,
      scale.supply_voltage_v > 0.0 ? fmt::format("{:.2f} V", scale.supply_voltage_v) : "its nominal voltage",
      scale.hover_throttle / scale.curve_throttle, scale.curve_slope_n);
  text += "  not identifiable    " + result.missing + "\n";
  for (const ulog::Loss& loss : result.losses) text += "  lost                " + text_of(loss) + "\n";
  if (result.ends_early) text += "  the log ends within a message: it is read up to there\n";
  return text;
}

nlohmann::ordered_json json_of(const Result& result) {
  const ThrustScale& scale = result.scale;
  nlohmann::ordered_json json = {{"log", result.log},
                                 {"hover_throttle", scale.hover_throttle},
                                 {"hover_throttle_half_width_95", k95 * scale.hover_deviation},
                                 {"slope_n", nullptr},
                                 {"slope_half_width_95_n", nullptr},
                                 {"residual_n", scale.residual_n},
                                 {"supply_voltage_v", scale.supply_voltage_v},
                                 {"vehicle_file_throttle", scale.curve_throttle},
                                 {"vehicle_file_slope_n", scale.curve_slope_n},
                                 {"flight_s", 0.1 * static_cast<double>(scale.blocks)},
                                 {"not_identifiable", result.missing}};
  if (scale.slope_known) {
    json["slope_n"] = scale.slope_n;
    json["slope_half_width_95_n"] = k95 * scale.slope_deviation;
  }
  json["lost"] = nlohmann::ordered_json::array();
  for (const ulog::Loss& loss : result.losses)
    json["lost"].push_back({{"bytes", loss.bytes}, {"from_s", loss.from_s}, {"until_s", loss.until_s}});
  return json;
}

}  // namespace

bool is_ulog(const std::string& file) {
  return file.size() > 4 && file.compare(file.size() - 4, 4, ".ulg") == 0;
}

int identify_ulog(const IdentifyFlightOptions& options, const plant::Vehicle& base,
                  const std::string& base_name) {
  for (const auto& [option, value] :
       {std::pair("--out", options.out), std::pair("--report", options.report)}) {
    if (!value.empty())
      throw io::InputError(std::string(option) +
                           ": a log of PX4 gives the thrust scale alone, no parameters of a vehicle file");
  }
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const std::string& file : options.logs) {
    if (!is_ulog(file)) throw io::InputError(file + ": is no log of PX4, as " + options.logs.front() + " is");
    const std::string bytes = io::read_text_file(file);
    const ulog::Log log(bytes, file);
    Result result{file, {}, missing_of(log), log.ends_early(), log.losses()};
    try {
      result.scale = identification::fit_thrust_scale(record_of(log, options), base);
    } catch (const identification::BadData& fault) {
      throw io::InputError(file + ": " + fault.what());
    }
    if (options.json) {
      all.push_back(json_of(result));
    } else {
      std::printf("%s", table_of(result, base, base_name).c_str());
    }
  }
  if (options.json)
    std::printf("%s\n", io::json_text(nlohmann::ordered_json{{"thrust_scales", all}}).c_str());
  return io::kDone;
}

}  // namespace swiftlet::analysis
