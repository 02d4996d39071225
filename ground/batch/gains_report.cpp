#include "swiftlet/ground/batch/gains_report.hpp"

#include <cmath>
#include <complex>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/control/design/flown_loops.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::ground {
namespace {

using Json = nlohmann::ordered_json;
using control::AttitudeAxisDesign;
using control::AttitudeModel;
using control::ControlDesign;
using control::PositionAxisDesign;
using Poles = std::vector<std::complex<double>>;

const char* to_string(AttitudeModel model) {
  return model == AttitudeModel::kDoubleIntegrator ? "double_integrator" : "motor_lag";
}

Eigen::Index state_count(AttitudeModel model) { return model == AttitudeModel::kDoubleIntegrator ? 2 : 3; }

template <typename Vector>
Json json_of(const Vector& values) {
  Json out = Json::array();
  for (const double value : values) out.push_back(value);
  return out;
}

Json json_of_poles(const Poles& poles) {
  Json out = Json::array();
  for (const std::complex<double>& pole : poles) out.push_back({pole.real(), pole.imag()});
  return out;
}

// An infinite margin is null.
Json json_of_margin(double degrees) { return std::isfinite(degrees) ? Json(degrees) : Json(nullptr); }

Json json_of(const AttitudeAxisDesign& axis) {
  const Eigen::Index n = state_count(axis.model);
  return {{"model", to_string(axis.model)},
          {"q", json_of(axis.weights.q.head(n))},
          {"r", axis.weights.r},
          {"k", json_of(axis.k.head(n))},
          {"poles", json_of_poles(axis.poles)},
          {"poles_with_motor_lag", json_of_poles(axis.poles_with_lag)},
          {"phase_margin_deg", json_of_margin(axis.phase_margin_deg)}};
}

Json json_of(const PositionAxisDesign& axis) {
  Json out = {{"omega_n", axis.settings.omega_n},
              {"zeta", axis.settings.zeta},
              {"epsilon", axis.settings.epsilon},
              {"integral_pole", axis.settings.integral_pole},
              {"f", json_of(axis.f)}};
  if (axis.settings.integral_pole > 0.0) {
    out["integral_form"] = {{"k_p", axis.gains.k_p}, {"k_v", axis.gains.k_v}, {"k_i", axis.gains.k_i}};
  }
  out["poles"] = json_of_poles(axis.poles);
  out["phase_margin_deg"] = json_of_margin(axis.phase_margin_deg);
  return out;
}

// Each conjugate pair once: "-5.5 +- 3.2i, -12".
std::string text_of(const Poles& poles) {
  std::string out;
  for (const std::complex<double>& pole : poles) {
    if (pole.imag() < 0.0) continue;
    if (!out.empty()) out += ", ";
    out += pole.imag() > 0.0 ? fmt::format("{:.3g} +- {:.3g}i", pole.real(), pole.imag())
                             : fmt::format("{:.3g}", pole.real());
  }
  return out;
}

std::string row(const char* name, const AttitudeAxisDesign& axis) {
  std::string k;
  for (Eigen::Index i = 0; i < state_count(axis.model); ++i) k += fmt::format(" {:8.4g}", axis.k[i]);
  return fmt::format("  {:<6}{:<27} {:7.1f}  ", name, k, axis.phase_margin_deg) +
         text_of(axis.poles_with_lag) + "\n";
}

std::string row(const char* name, const PositionAxisDesign& axis) {
  return fmt::format("  {:<6} {:8.3f} {:8.3f} {:8.3f} {:7.1f}  ", name, axis.gains.k_p, axis.gains.k_v,
                     axis.gains.k_i, axis.phase_margin_deg) +
         text_of(axis.poles) + "\n";
}

std::string attitude_heading(AttitudeModel model) {
  const bool lag = model == AttitudeModel::kMotorLag;
  return fmt::format("attitude: LQR designed on {}; moment / inertia = -k (angle, rate{}), rad/s^2\n",
                     lag ? "the motor-lag model" : "double integrators", lag ? ", moment / inertia" : "") +
         fmt::format("            angle     rate {:>8}  margin  poles\n", lag ? "moment" : "") +
         fmt::format("            1/s^2      1/s {:>8}     deg  rad/s\n", lag ? "1" : "");
}

Json json_of(const control::LoopMargins& margins) {
  return {{"phase_deg", json_of_margin(margins.phase_deg)},
          {"gain_increase_db", json_of_margin(control::decibels(margins.gain_increase))},
          {"gain_decrease_db", json_of_margin(control::decibels(margins.gain_decrease))},
          {"delay_s", json_of_margin(margins.delay_s)}};
}

Json json_of(const MarginStudy& study) {
  Json out = Json::object();
  for (std::size_t i = 0; i < kLoopNames.size(); ++i) {
    const MarginStudy::Loop& loop = study.loops[i];
    out[kLoopNames[i]] = {{"designed", json_of(loop.designed)}};
    if (study.samples == 0) continue;
    out[kLoopNames[i]]["most"] = json_of(loop.most);
    out[kLoopNames[i]]["worst"] = json_of(loop.worst);
  }
  return out;
}

std::string margin_text(const control::LoopMargins& m) {
  return fmt::format("{:6.1f}", m.phase_deg) + " " + decibels_text(m.gain_decrease) + " " +
         decibels_text(m.gain_increase) + fmt::format(" {:6.1f}", m.delay_s * 1e3);
}

std::string text_of(const MarginStudy& study) {
  std::string out =
      "margins: phase (deg), lower and upper gain (dB), delay (ms)\n  loop   nominal vehicle            ";
  if (study.samples > 0) {
    out += fmt::format("   held by 95 % of {} samples  worst sample\n", study.samples);
  } else {
    out += "   (the vehicle file states no parameter uncertainty)\n";
  }
  for (std::size_t i = 0; i < kLoopNames.size(); ++i) {
    out += fmt::format("  {:<6} ", kLoopNames[i]) + margin_text(study.loops[i].designed);
    if (study.samples > 0)
      out += "   " + margin_text(study.loops[i].most) + "   " + margin_text(study.loops[i].worst);
    out += "\n";
  }
  if (study.unstable > 0) out += fmt::format("  unstable: {} of {} samples\n", study.unstable, study.samples);
  return out;
}

Json json_of_delays(const FlownDelays& delays_s) {
  Json out = Json::object();
  for (std::size_t i = 0; i < delays_s.size(); ++i)
    out[control::kFlownLoopNames[i]] = json_of_margin(delays_s[i]);
  return out;
}

std::string text_of(const FlownDelays& delays_s) {
  std::string out =
      "delay from a sample to the rotors that each loop tolerates in flight, with the observers (ms); "
      "sampling takes "
      "half a\nperiod of the IMU of it, 1 ms at 500 Hz\n";
  for (std::size_t i = 0; i < delays_s.size(); ++i) {
    out += fmt::format("  {:<6} ", control::kFlownLoopNames[i]) +
           (std::isfinite(delays_s[i]) ? fmt::format("{:6.1f}", delays_s[i] * 1e3) : "   any") + "\n";
  }
  return out;
}

}  // namespace

std::string decibels_text(double factor) {
  return factor > 0.0 && std::isfinite(factor) ? fmt::format("{:+6.1f}", control::decibels(factor))
                                               : "   any";
}

std::string gains_json(const ControlDesign& design, const MarginStudy& margins,
                       const FlownDelays& flown_delay_s, const std::string& vehicle,
                       const std::string& control) {
  const Json out = {
      {"vehicle", vehicle},
      {"control", control},
      {"rotor_lag_s", design.rotor_lag_s},
      {"thrust_lead", design.thrust_lead},
      {"attitude",
       {{"roll", json_of(design.roll)}, {"pitch", json_of(design.pitch)}, {"yaw", json_of(design.yaw)}}},
      {"position", {{"x", json_of(design.x)}, {"y", json_of(design.y)}, {"z", json_of(design.z)}}},
      {"margins", json_of(margins)},
      {"flown_delay_s", json_of_delays(flown_delay_s)},
      {"samples", margins.samples},
      {"seed", margins.seed},
      {"unstable", margins.unstable}};
  return io::json_text(out, 2);
}

std::string gains_table(const ControlDesign& design, const MarginStudy& margins,
                        const FlownDelays& flown_delay_s, const std::string& vehicle,
                        const std::string& control) {
  const std::string lead =
      design.thrust_lead > 0.0
          ? fmt::format(", in z {:.4g} s by the thrust lead of {:g}",
                        design.rotor_lag_s / (1.0 + design.thrust_lead), design.thrust_lead)
          : "";
  return fmt::format("{} with {}; all margins and poles (rad/s) include the rotor lag of {:.4g} s{}\n",
                     vehicle.c_str(), control.c_str(), design.rotor_lag_s, lead) +
         attitude_heading(design.roll.model) + row("roll", design.roll) + row("pitch", design.pitch) +
         row("yaw", design.yaw) +
         "position: RPT around the closed attitude loop; gains give m/s^2\n"
         "              k_p      k_v      k_i  margin  poles\n"
         "            1/s^2      1/s    1/s^3     deg  rad/s\n" +
         row("x", design.x) + row("y", design.y) + row("z", design.z) + text_of(margins) +
         text_of(flown_delay_s);
}

}  // namespace swiftlet::ground
