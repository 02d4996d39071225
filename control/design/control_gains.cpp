#include "swiftlet/control/design/control_gains.hpp"

#include <array>
#include <cstdio>
#include <string>
#include <utility>

#include "swiftlet/control/design/margins.hpp"

namespace swiftlet::control {
namespace {

constexpr int kSteps = 20;  // of the change; each is checked

using NamedLoop = std::pair<const char*, Loop>;

std::array<NamedLoop, 6> loops_of(const ControlGains& gains, double rotor_lag_s) {
  const RotorResponse rotors{rotor_lag_s};
  const auto attitude_k = [&](Eigen::Index axis) {
    return Eigen::Vector3d(gains.attitude_angle[axis], gains.attitude_rate[axis],
                           gains.attitude_acceleration[axis]);
  };
  const auto position_k = [&](Eigen::Index axis) {
    return RptGains{gains.position_p[axis], gains.position_v[axis], gains.position_i[axis]};
  };
  return {{{"attitude.roll", attitude_loop(attitude_k(0), rotors)},
           {"attitude.pitch", attitude_loop(attitude_k(1), rotors)},
           {"attitude.yaw", attitude_loop(attitude_k(2), rotors)},
           {"position.x", horizontal_position_loop(position_k(0), attitude_k(1), rotors)},
           {"position.y", horizontal_position_loop(position_k(1), attitude_k(0), rotors)},
           {"position.z", vertical_position_loop(position_k(2), rotors)}}};
}

std::string fault_of(const LoopMargins& margin, double fraction) {
  char when[40] = "";
  if (fraction < 1.0) std::snprintf(when, sizeof when, " at %.0f %% of the change", 100.0 * fraction);
  char message[120];
  if (margin.delay_s > 0.0) {
    std::snprintf(message, sizeof message,
                  "the loop tolerates a delay of %.1f ms%s, must be at least %.0f ms", 1e3 * margin.delay_s,
                  when, 1e3 * kLeastDelayMargin_s);
  } else {
    std::snprintf(message, sizeof message, "with the rotor lag the loop is unstable%s", when);
  }
  return message;
}

}  // namespace

ControlGains control_gains(const ControlDesign& design, const ControlSettings& settings) {
  const auto of_attitude = [&](Eigen::Index i) {
    return Eigen::Vector3d(design.roll.k[i], design.pitch.k[i], design.yaw.k[i]);
  };
  const auto of_position = [&](double RptGains::*k) {
    return Eigen::Vector3d(design.x.gains.*k, design.y.gains.*k, design.z.gains.*k);
  };
  ControlGains gains;
  gains.attitude_angle = of_attitude(0);
  gains.attitude_rate = of_attitude(1);
  gains.attitude_acceleration = of_attitude(2);
  gains.position_p = of_position(&RptGains::k_p);
  gains.position_v = of_position(&RptGains::k_v);
  gains.position_i = of_position(&RptGains::k_i);
  gains.integral_limit = settings.position.integral_limit;
  gains.disturbance_bandwidth = settings.disturbance.bandwidth;
  gains.disturbance_limit = settings.disturbance.limit;
  return gains;
}

std::optional<plant::Violation> unstable_change(const ControlGains& from, const ControlGains& to,
                                                double rotor_lag_s) {
  for (int step = kSteps; step >= 1; --step) {  // the end first: its fault is the plainest
    const double fraction = static_cast<double>(step) / kSteps;
    for (const auto& [key, loop] : loops_of(blend(from, to, fraction), rotor_lag_s)) {
      const LoopMargins margin = margins(loop);
      if (margin.delay_s >= kLeastDelayMargin_s) continue;
      return plant::Violation{key, fault_of(margin, fraction)};
    }
  }
  return std::nullopt;
}

}  // namespace swiftlet::control
