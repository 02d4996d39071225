#include "swiftlet/control/planning/feasibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>

#include "swiftlet/control/planning/bernstein.hpp"
#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/position/thrust_attitude_map.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/propulsion.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Vector3d;

constexpr double kMaxRotorSamples = 1e6;  // most samples of the rotors on a path

constexpr std::array<const char*, 9> kUnits = {"m", "m/s", "m/s^2", "rad/s", "m/s^2", "rad", "N", "N", "N"};

bool is_least(Demand demand) { return demand == Demand::kLift || demand == Demand::kRotorLeast; }

// The reference plus drag: drag acts as an acceleration in proportion to the velocity, and its derivatives
// accordingly.
Reference with_drag(const Reference& reference, double drag_per_mass) {
  Reference effective = reference;
  effective.acceleration_ned += drag_per_mass * reference.velocity_ned;
  effective.jerk_ned += drag_per_mass * reference.acceleration_ned;
  effective.snap_ned += drag_per_mass * reference.jerk_ned;
  return effective;
}

class Survey {
 public:
  Survey(const plant::Vehicle& vehicle, const Limits& limits, double supply_voltage_v, double duration_s)
      : vehicle_(vehicle),
        limits_(limits),
        drag_per_mass_(vehicle.linear_drag / vehicle.mass_kg),
        rotor_step_s_(std::max(kRotorStep_s, duration_s / kMaxRotorSamples)) {
    for_wrench_ = plant::pseudo_inverse(plant::effectiveness(vehicle));
    const plant::ThrustRange rotor = plant::steady_thrust_range(vehicle, supply_voltage_v);
    begin(Demand::kFence, 0.0);
    begin(Demand::kSpeed, limits.max_speed);
    begin(Demand::kAcceleration, limits.max_acceleration);
    begin(Demand::kYawRate, limits.max_yaw_rate);
    begin(Demand::kLift, kMinimumLift * plant::kGravity);
    begin(Demand::kTilt, limits.max_tilt_rad);
    begin(Demand::kThrust, vehicle.rotor_count() * rotor.max);
    begin(Demand::kRotorLeast, rotor.min);
    begin(Demand::kRotorMost, rotor.max);
  }

  void add(const PolynomialSegment& segment) {
    add_motion(segment);
    add_force(segment);
    add_rotors(segment);
    start_s_ += segment.duration_s;
    ++index_;
  }
  std::vector<WorstDemand> take() { return std::move(worst_); }

 private:
  void begin(Demand demand, double limit) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    worst_.push_back({demand, is_least(demand) ? kNone : -kNone, limit, 0, 0.0, Vector3d::Zero()});
  }
  WorstDemand& of(Demand demand) { return worst_[static_cast<std::size_t>(demand)]; }

  void note(Demand demand, double value, const PolynomialSegment& segment, double t_s) {
    WorstDemand& worst = of(demand);
    if (is_least(demand) ? value >= worst.value : value <= worst.value) return;
    worst.value = value;
    worst.segment = index_;
    worst.time_s = start_s_ + t_s;
    worst.position_ned = evaluate(segment, t_s).position_ned;
  }
  void note_root(Demand demand, const Bernstein& square, double factor, const PolynomialSegment& segment) {
    const double limit = of(demand).limit / factor;
    const Extremum most = maximum(square, kExtremumPrecision * limit * limit);
    note(demand, factor * std::sqrt(std::max(most.value, 0.0)), segment, most.at * segment.duration_s);
  }

  void add_motion(const PolynomialSegment& segment) {
    const std::array<const Polynomial*, 3> axes = {&segment.x, &segment.y, &segment.z};
    const double precision_m = 1e-6;
    for (int i = 0; i < 3; ++i) {
      const Bernstein position = bernstein(*axes[static_cast<std::size_t>(i)], segment.duration_s);
      const Extremum high = maximum(position, precision_m);
      const Extremum low = minimum(position, precision_m);
      note(Demand::kFence, high.value - limits_.fence_max_ned[i], segment, high.at * segment.duration_s);
      note(Demand::kFence, limits_.fence_min_ned[i] - low.value, segment, low.at * segment.duration_s);
    }
    const auto square = [&](int derivative) {
      const auto axis = [&](const Polynomial& p) { return bernstein(p, segment.duration_s, derivative); };
      return squared_length(axis(segment.x), axis(segment.y), axis(segment.z));
    };
    note_root(Demand::kSpeed, square(1), 1.0, segment);
    note_root(Demand::kAcceleration, square(2), 1.0, segment);
    const Bernstein yaw_rate = bernstein(segment.yaw, segment.duration_s, 1);
    note_root(Demand::kYawRate, yaw_rate * yaw_rate, 1.0, segment);
  }

  // b = g e3 - a - (c / m) v: the specific force of the rotors, along body z.
  void add_force(const PolynomialSegment& segment) {
    const auto axis = [&](const Polynomial& p, double gravity) {
      return constant(gravity) - bernstein(p, segment.duration_s, 2) -
             drag_per_mass_ * bernstein(p, segment.duration_s, 1);
    };
    const Bernstein x = axis(segment.x, 0.0);
    const Bernstein y = axis(segment.y, 0.0);
    const Bernstein z = axis(segment.z, plant::kGravity);
    const Extremum least = minimum(z, kExtremumPrecision * plant::kGravity);
    note(Demand::kLift, least.value, segment, least.at * segment.duration_s);
    note_root(Demand::kThrust, squared_length(x, y, z), vehicle_.mass_kg, segment);

    // The tilt exceeds its limit where the horizontal part is longer than tan(limit) times the vertical one.
    const double tangent = std::tan(limits_.max_tilt_rad);
    const Bernstein beyond = squared_length(x, y) - tangent * tangent * squared_length(z);
    const double tolerance = kExtremumPrecision * plant::kGravity * plant::kGravity;
    const Extremum most = maximum(beyond, tolerance);
    const auto force_at = [&](double at) -> Vector3d {
      const Reference effective = with_drag(evaluate(segment, at * segment.duration_s), drag_per_mass_);
      return Vector3d(0.0, 0.0, plant::kGravity) - effective.acceleration_ned;
    };
    for (const double at : {most.at, least.at}) {
      const Vector3d b = force_at(at);
      note(Demand::kTilt, std::atan2(b.head<2>().norm(), b.z()), segment, at * segment.duration_s);
    }
    // If the search did not suffice, most.value is an upper bound that is not attained. Above 0 it does not
    // exclude a violation: the tilt is then bounded by that of this horizontal part at the least vertical one.
    const Vector3d b = force_at(most.at);
    const double attained = b.head<2>().squaredNorm() - tangent * tangent * b.z() * b.z();
    if (most.value > std::max(0.0, attained + tolerance)) {
      const double vertical = std::max(least.value, 0.0);
      const double horizontal = std::sqrt(tangent * tangent * vertical * vertical + most.value);
      note(Demand::kTilt, std::atan2(horizontal, vertical), segment, most.at * segment.duration_s);
    }
  }

  void add_rotors(const PolynomialSegment& segment) {
    const auto samples =
        static_cast<std::int64_t>(std::max(1.0, std::ceil(segment.duration_s / rotor_step_s_)));
    for (std::int64_t i = 0; i <= samples; ++i) {
      const double t_s = segment.duration_s * static_cast<double>(i) / static_cast<double>(samples);
      const Reference effective = with_drag(evaluate(segment, t_s), drag_per_mass_);
      const ReferenceMotion motion = reference_motion(vehicle_.mass_kg, effective, effective.yaw_rad);
      // Euler's equation: J omega' + omega x J omega.
      const Vector3d moment = vehicle_.inertia * motion.body_accelerations +
                              motion.body_rates.cross(vehicle_.inertia * motion.body_rates);
      const plant::RotorThrusts thrusts =
          for_wrench_ * Eigen::Vector4d(motion.thrust_n, moment.x(), moment.y(), moment.z());
      note(Demand::kRotorLeast, thrusts.minCoeff(), segment, t_s);
      note(Demand::kRotorMost, thrusts.maxCoeff(), segment, t_s);
    }
  }

  const plant::Vehicle& vehicle_;
  const Limits& limits_;
  double drag_per_mass_;  // 1/s
  double rotor_step_s_;
  plant::Allocation for_wrench_;
  std::vector<WorstDemand> worst_;
  std::size_t index_ = 0;
  double start_s_ = 0.0;  // of the segment
};

}  // namespace

const char* to_string(Demand demand) {
  switch (demand) {
    case Demand::kFence:
      return "distance beyond the fence";
    case Demand::kSpeed:
      return "speed";
    case Demand::kAcceleration:
      return "acceleration";
    case Demand::kYawRate:
      return "yaw rate";
    case Demand::kLift:
      return "upward specific force";
    case Demand::kTilt:
      return "tilt";
    case Demand::kThrust:
      return "thrust";
    case Demand::kRotorLeast:
      return "least thrust of a rotor";
    case Demand::kRotorMost:
      return "greatest thrust of a rotor";
  }
  return "unknown";
}

const char* unit_of(Demand demand) { return kUnits[static_cast<std::size_t>(demand)]; }

bool WorstDemand::exceeded() const {
  const double tolerance = 2.0 * kExtremumPrecision * std::max(std::abs(limit), 1e-3);
  return is_least(demand) ? value < limit - tolerance : value > limit + tolerance;
}

std::string WorstDemand::sentence() const {
  char text[192];
  const char* const unit = unit_of(demand);
  std::snprintf(text, sizeof text,
                "%s is %.3f %s, the limit is %.3f %s: at %.2f s, segment %zu, (%.2f, %.2f, %.2f) m NED",
                to_string(demand), value, unit, limit, unit, time_s, segment + 1, position_ned.x(),
                position_ned.y(), position_ned.z());
  return text;
}

std::vector<WorstDemand> worst_demands(const plant::Vehicle& vehicle, const Limits& limits,
                                       double supply_voltage_v,
                                       const std::vector<PolynomialSegment>& segments) {
  double duration_s = 0.0;
  for (const PolynomialSegment& segment : segments) duration_s += segment.duration_s;
  Survey survey(vehicle, limits, supply_voltage_v, duration_s);
  for (const PolynomialSegment& segment : segments) survey.add(segment);
  return survey.take();
}

Outcome check_rotors(const char* what, const plant::Vehicle& vehicle, const Limits& limits,
                     double supply_voltage_v, const std::vector<PolynomialSegment>& segments) {
  if (segments.empty()) return accept();
  for (const WorstDemand& worst : worst_demands(vehicle, limits, supply_voltage_v, segments)) {
    const bool of_rotors =
        worst.demand == Demand::kThrust || is_least(worst.demand) || worst.demand == Demand::kRotorMost;
    if (of_rotors && worst.exceeded()) return refuse("%s: %s", what, worst.sentence().c_str());
  }
  return accept();
}

}  // namespace swiftlet::control
