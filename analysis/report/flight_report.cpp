#include "swiftlet/analysis/report/flight_report.hpp"

#include <cmath>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/services/runtime/clock.hpp"

namespace swiftlet::analysis {
namespace {

const std::string kRealtime = runtime::to_string(runtime::Clock::kRealtime);

nlohmann::ordered_json axes(const std::array<double, 3>& values) {
  return {{"x", values[0]}, {"y", values[1]}, {"z", values[2]}};
}

// Where the samples end by which the flight is judged.
std::string end_of(const FlightReport& report) {
  if (!report.record_fault.empty()) return "the end of the record";
  return report.completed ? "landing" : "the end of the flight";
}

}  // namespace

nlohmann::ordered_json to_json(const FlightReport& report) {
  nlohmann::ordered_json json;
  json["completed"] = report.completed;
  if (!report.completed) json["reason"] = report.reason;
  json["clock"] = report.clock;
  json["mission"] = report.mission;
  if (!report.vehicle_name.empty()) json["vehicle_name"] = report.vehicle_name;
  json["start_m"] = {report.start_ned.x(), report.start_ned.y()};
  json["vehicle"] = report.vehicle;
  json["control"] = report.control;
  if (!report.dispersion.empty()) json["dispersion"] = report.dispersion;
  json["seed"] = report.seed;
  json["record_dir"] = report.record_dir;
  if (!report.record_fault.empty()) json["record_fault"] = report.record_fault;
  if (!report.warnings.empty()) json["warnings"] = report.warnings;
  json["duration_s"] = report.duration_s;
  json["tolerance_m"] = report.tolerance_m;
  json["errors_against"] = record::to_string(report.errors.against);
  json["rms_3d_m"] = report.errors.rms_3d_m;
  json["peak_3d_m"] = report.errors.peak_3d_m;
  json["rms_m"] = axes(report.errors.rms_m);
  json["peak_m"] = axes(report.errors.peak_m);
  json["matched_samples"] = report.errors.matched;
  json["longest_gap_s"] = report.errors.longest_gap_s;
  json["simulated_s"] = report.simulated_s;
  json["wall_s"] = report.wall_s;
  json["real_time_factor"] = report.simulated_s / report.wall_s;
  json["control_rate_hz"] = report.control_rate_hz;
  json["imu_rate_hz"] = report.imu_rate_hz;
  json["cycles"] = report.cycles;
  json["deadline_misses"] = report.deadline_misses;
  json["unanswered"] = report.unanswered;
  json["step_time_max_us"] = report.step_time_max_us;
  json["realtime_scheduling"] = report.realtime_scheduling;
  json["sense_to_actuate_us"] = {{"p50", report.sense_to_actuate.p50_us},
                                 {"p99", report.sense_to_actuate.p99_us},
                                 {"max", report.sense_to_actuate.max_us}};
  return json;
}

std::string to_text(const FlightReport& report) {
  constexpr double kMm = 1e3;
  const auto& errors = report.errors;
  std::string text =
      report.mission + (report.completed ? ": completed" : ": NOT completed: " + report.reason);
  text += fmt::format("\n  duration          {:.1f} s\n", report.duration_s);
  if (errors.matched > 0) {
    text += "  tracking error       north    east    down     3-D\n";
    text += fmt::format("    RMS         mm  {:8.2f}{:8.2f}{:8.2f}{:8.2f}\n", errors.rms_m[0] * kMm,
                        errors.rms_m[1] * kMm, errors.rms_m[2] * kMm, errors.rms_3d_m * kMm);
    text += fmt::format("    peak        mm  {:8.2f}{:8.2f}{:8.2f}{:8.2f}   (tolerance {:.0f})\n",
                        errors.peak_m[0] * kMm, errors.peak_m[1] * kMm, errors.peak_m[2] * kMm,
                        errors.peak_3d_m * kMm, report.tolerance_m * kMm);
    text += fmt::format("    from {} samples, takeoff to {}", errors.matched, end_of(report));
    if (errors.against != record::Against::kGroundTruth)
      text += fmt::format(", against {}", record::to_string(errors.against));
    text += "\n";
  }
  if (report.clock != kRealtime && report.wall_s > 0.0) {
    text += fmt::format("  simulated         {:.1f} s in {:.2f} s, {}: {:.0f} times real time\n",
                        report.simulated_s, report.wall_s, report.clock.c_str(),
                        report.simulated_s / report.wall_s);
  } else if (report.cycles > 0) {
    text += fmt::format("  control rate      {:.1f} Hz, {} of {} steps late by more than half a period{}\n",
                        report.control_rate_hz, static_cast<unsigned long long>(report.deadline_misses),
                        static_cast<unsigned long long>(report.cycles),
                        report.realtime_scheduling ? "" : " (no real-time scheduling)");
    if (report.sense_to_actuate.max_us > 0.0) {
      text += fmt::format("  sense to actuate  p50 {:.0f} us, p99 {:.0f} us, max {:.0f} us\n",
                          report.sense_to_actuate.p50_us, report.sense_to_actuate.p99_us,
                          report.sense_to_actuate.max_us);
    } else {
      text += "  sense to actuate  not measured by the vehicle\n";
    }
  }
  if (!report.dispersion.empty())
    text += fmt::format("  dispersion        {}, seed {}\n", report.dispersion.c_str(),
                        static_cast<unsigned long long>(report.seed));
  for (const std::string& warning : report.warnings) text += "  warning           " + warning + "\n";
  if (!report.record_dir.empty()) text += "  record            " + report.record_dir + "\n";
  return text;
}

}  // namespace swiftlet::analysis
