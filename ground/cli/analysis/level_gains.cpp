#include "swiftlet/ground/cli/analysis/level_gains.hpp"

#include <cmath>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/control/design/control_gains.hpp"
#include "swiftlet/control/design/flown_delay.hpp"
#include "swiftlet/control/design/margins.hpp"
#include "swiftlet/ground/batch/gains_report.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/plant/simulation/firmware/gains.hpp"

namespace swiftlet::ground {
namespace {

using Json = nlohmann::ordered_json;
using plant::ControlLevel;

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json json_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

const char* closed_by(ControlLevel level, std::size_t i) {
  return control::closed_by_control(level, i) ? "control" : "vehicle";
}

// What the loop at this place multiplies its error with.
std::string gain_text(const LevelGains& of, std::size_t i) {
  const auto axis = static_cast<Eigen::Index>(i % 3);
  if (i < 3) {
    const bool control = control::closed_by_control(of.level, i);
    return fmt::format(
        "{:8.3f} {:8} {:8}",
        control ? control::rate_per_angle(of.gains)[axis] : of.loops_of_vehicle.attitude_p[axis], "", "");
  }
  if (control::closed_by_control(of.level, i))
    return fmt::format("{:8.3f} {:8.3f} {:8.3f}", of.gains.position_p[axis], of.gains.position_v[axis],
                       of.gains.position_i[axis]);
  const control::VehicleLoops& own = of.loops_of_vehicle;
  return fmt::format("{:8.3f} {:8.3f} {:8.3f}", own.velocity_p * own.position_p + own.velocity_i,
                     own.velocity_p, own.velocity_i * own.position_p);
}

std::string milliseconds_text(double delay_s) {
  return std::isfinite(delay_s) ? fmt::format("{:6.1f}", 1e3 * delay_s) : "   any";
}

}  // namespace

control::VehicleLoops vehicle_loops(const plant::Vehicle& vehicle) {
  const plant::FirmwareGains firmware = plant::firmware_gains(vehicle);
  control::VehicleLoops loops;
  loops.rate_p = firmware.rates.p;
  loops.rate_i = firmware.rates.i;
  loops.rate_d = firmware.rates.d;
  loops.derivative_cutoff = firmware.rates.derivative_cutoff;
  loops.attitude_p = firmware.attitude.p;
  loops.position_p = firmware.position.position_p;
  loops.velocity_p = firmware.position.velocity_p;
  loops.velocity_i = firmware.position.velocity_i;
  return loops;
}

LevelGains level_gains(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                       ControlLevel level, double delay_s) {
  const control::ControlDesign design = control::design(vehicle, settings);
  LevelGains out;
  out.vehicle = vehicle.name;
  out.control = settings.name;
  out.level = level;
  out.delay_s = delay_s;
  out.rotor_lag_s = design.rotor_lag_s;
  out.loops_of_vehicle = vehicle_loops(vehicle);
  out.gains = control::control_gains(design, settings);
  const control::ObservedRotors rotors{design.rotor_lag_s, settings.estimator.rotor_speed_bandwidth};
  const auto loops_at = [&](double at_s) {
    return control::level_loops(level, out.gains, rotors, out.loops_of_vehicle, at_s);
  };
  const std::array<control::FlownLoop, 6> loops = loops_at(delay_s);
  for (std::size_t i = 0; i < loops.size(); ++i) out.margins[i] = control::margins(loops[i].loop);
  out.tolerated_delay_s = control::delay_margins(loops_at);
  return out;
}

std::string level_gains_json(const LevelGains& of) {
  const control::VehicleLoops& own = of.loops_of_vehicle;
  Json out = {{"vehicle", of.vehicle},
              {"control", of.control},
              {"level", plant::to_string(of.level)},
              {"delay_s", of.delay_s},
              {"rotor_lag_s", of.rotor_lag_s},
              {"vehicle_loops",
               {{"rate_p", json_of(own.rate_p)},
                {"rate_i", json_of(own.rate_i)},
                {"rate_d", json_of(own.rate_d)},
                {"derivative_cutoff", own.derivative_cutoff},
                {"attitude_p", json_of(own.attitude_p)},
                {"position_p", own.position_p},
                {"velocity_p", own.velocity_p},
                {"velocity_i", own.velocity_i}}},
              {"control_loops",
               {{"rate_per_angle", json_of(control::rate_per_angle(of.gains))},
                {"position_p", json_of(of.gains.position_p)},
                {"position_v", json_of(of.gains.position_v)},
                {"position_i", json_of(of.gains.position_i)}}}};
  Json loops = Json::object();
  for (std::size_t i = 0; i < of.margins.size(); ++i) {
    const control::LoopMargins& m = of.margins[i];
    loops[control::kFlownLoopNames[i]] = {{"closed_by", closed_by(of.level, i)},
                                          {"phase_deg", finite(m.phase_deg)},
                                          {"gain_increase_db", finite(control::decibels(m.gain_increase))},
                                          {"gain_decrease_db", finite(control::decibels(m.gain_decrease))},
                                          {"tolerated_delay_s", finite(of.tolerated_delay_s[i])}};
  }
  out["loops"] = loops;
  return io::json_text(out, 2);
}

std::string level_gains_table(const LevelGains& of) {
  const control::VehicleLoops& own = of.loops_of_vehicle;
  std::string out = fmt::format(
      "{} with {} at level {}, {:g} ms from a sample to the vehicle; rotor lag {:.4g} s\n"
      "vehicle, as the simulated firmware: rates p {:.3g} 1/s, i {:.3g} 1/s^2, d {:.3g} (roll), attitude p "
      "{:.3g} 1/s\n"
      "                       gains                      phase  lower  upper  tolerated\n"
      "  loop   closed by  1/s or 1/s^2  1/s    1/s^3     deg     dB     dB  delay, ms\n",
      of.vehicle, of.control, plant::to_string(of.level), 1e3 * of.delay_s, of.rotor_lag_s, own.rate_p.x(),
      own.rate_i.x(), own.rate_d.x(), own.attitude_p.x());
  for (std::size_t i = 0; i < of.margins.size(); ++i) {
    const control::LoopMargins& m = of.margins[i];
    out += fmt::format("  {:<6} {:<8} {}  {:6.1f} {} {}     {}\n", control::kFlownLoopNames[i],
                       closed_by(of.level, i), gain_text(of, i), m.phase_deg, decibels_text(m.gain_decrease),
                       decibels_text(m.gain_increase), milliseconds_text(of.tolerated_delay_s[i]));
  }
  return out;
}

}  // namespace swiftlet::ground
