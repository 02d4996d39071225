#include "swiftlet/control/guidance/spool_up.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/control/guidance/manoeuvres.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::control {
namespace {

constexpr double kSpoolUp_s = 0.8;
constexpr double kSpoolUpLift = 0.95;  // of the weight, at the end of the spool-up
// Where lift-off is observed, thrust rises fast up to a lift below that of any vehicle, then slowly until lift-off.
constexpr double kFastLift = 0.75;  // of the weight
constexpr double kFastLift_s = 0.45;
constexpr double kLiftRate = 3.0;        // of the weight, per second
constexpr double kMostLift = 1.5;        // of the weight
constexpr double kMostLead = 0.08;       // of the weight, by which the commanded lift may lead the obeyed one
constexpr double kAwaitLiftOff_s = 0.8;  // after the greatest lift
constexpr double kSettle_s = 0.09;  // after the vehicle has answered its lift-off: its thrust is steady again
constexpr double kRiseSpeed = 0.05;        // m/s, from lift-off until it is clear of the ground
constexpr double kMostRiseSpeed = 0.2;     // m/s
constexpr double kClearHeight_m = 0.003;   // above the ground
constexpr double kTest_s = 0.25;           // of the motion of a hover test
constexpr double kTestAcceleration = 1.0;  // m/s^2
constexpr double kTestClimb = 2.0;         // m/s^2
constexpr double kTestYaw_rad = -0.4;
constexpr double kLongestSample_s = 0.01;  // between two steps

// The lift rises at this rate, in weights per second. Lift-off is seen and answered later by the delay of the commands:
// the lift must not have risen much until then.
double lift_rate(const GuidanceContext& context) {
  return context.command_delay_s * kLiftRate > kMostLead ? kMostLead / context.command_delay_s : kLiftRate;
}

double longest_spool_up_s(const GuidanceContext& context) {
  return kFastLift_s + (kMostLift - kFastLift) / lift_rate(context) + kAwaitLiftOff_s;
}

// After the lift-off of a hover test: moves a little to all sides and turns, at rest again at its end, so that what the vehicle
// does can be compared with what was commanded.
void rise_in_test(const GuidanceContext& context, const Eigen::Vector3d& place_ned) {
  const double t = kTest_s;
  PolynomialSegment motion;
  motion.duration_s = kTest_s;
  // North by an acceleration of a (1 - 2 s), west by one of 12 a s (s - 1/2) (s - 1), with s from 0 to 1.
  const double a = kTestAcceleration * t * t;
  motion.x = {place_ned.x(), 0.0, a / 2.0 / (t * t), -a / 3.0 / (t * t * t)};
  motion.y = {
      place_ned.y(), 0.0, 0.0, -a / std::pow(t, 3), 1.5 * a / std::pow(t, 4), -0.6 * a / std::pow(t, 5)};
  // Up by one of b (1 - s): the feet must be clear before they tilt.
  motion.z = {place_ned.z(), -kRiseSpeed, -kTestClimb / 2.0, kTestClimb / (6.0 * t)};
  motion.yaw = {context.state.path.at(context.now_ns).yaw_rad + kTestYaw_rad};
  context.state.path.follow(motion, context.now_ns);
}

// A reference that moves up from a place since start_ns.
void rise_from(const GuidanceContext& context, const Eigen::Vector3d& place_ned, double speed,
               std::int64_t start_ns) {
  PolynomialSegment up;
  up.duration_s = longest_spool_up_s(context);
  up.x = {place_ned.x()};
  up.y = {place_ned.y()};
  up.z = {place_ned.z(), -speed};
  up.yaw = {context.state.path.at(context.now_ns).yaw_rad};
  context.state.path.follow(up, start_ns);
}

void climb_from(const GuidanceContext& context, Eigen::Vector3d top, std::int64_t start_ns) {
  GuidanceState& state = context.state;
  state.phase = Phase::kPath;
  top.z() = state.climb_to_z_ned;
  start_move(context, top, true, 0.0, state.climb_speed, start_ns);
}

}  // namespace

void start_takeoff(const GuidanceContext& context, double to_z_ned, double speed, std::int64_t start_ns) {
  GuidanceState& state = context.state;
  state.phase = Phase::kSpoolUp;
  state.phase_since_ns = start_ns;
  state.climb_to_z_ned = to_z_ned;
  state.climb_speed = speed;
  state.path.rest(standing_at(context.estimate));
}

void advance_spool_up(const GuidanceContext& context) {
  GuidanceState& state = context.state;
  const double elapsed = elapsed_s(state.phase_since_ns, context.now_ns);
  const Eigen::Vector3d& place_ned = context.estimate.position_ned;
  const bool on_time = elapsed >= kSpoolUp_s;
  const std::int64_t due_ns = state.phase_since_ns + math::nanoseconds(kSpoolUp_s);
  if (context.lift_off_ns == 0) {
    if (on_time) climb_from(context, state.path.at(context.now_ns).position_ned, due_ns);
    return;
  }
  const bool lifted_off = context.lift_off_ns <= context.now_ns;
  if (lifted_off && !state.path.moving && context.hover_test)
    rise_in_test(context, state.path.at(context.now_ns).position_ned);
  if (lifted_off && !state.path.moving)
    rise_from(context, state.path.at(context.now_ns).position_ned, kRiseSpeed, context.now_ns);
  const double clear_z_ned = state.ground_z_ned - kClearHeight_m;
  const bool settled = lifted_off && elapsed_s(context.lift_off_ns, context.now_ns) >=
                                         context.command_delay_s + (context.hover_test ? kTest_s : kSettle_s);
  if (settled && on_time && place_ned.z() < clear_z_ned) {
    const double speed = std::clamp(-context.estimate.velocity_ned.z(), 0.0, kMostRiseSpeed);
    const double late_s = elapsed - kSpoolUp_s;
    Eigen::Vector3d place_then_ned = place_ned;
    place_then_ned.z() += late_s * speed;
    const bool was_clear = late_s < kLongestSample_s && place_then_ned.z() < clear_z_ned;
    const std::int64_t start_ns = was_clear ? due_ns : context.now_ns;
    rise_from(context, was_clear ? place_then_ned : place_ned, speed, start_ns);
    return climb_from(context, place_ned, start_ns);
  }
  if (elapsed >= longest_spool_up_s(context))
    climb_from(context, state.path.at(context.now_ns).position_ned, context.now_ns);
}

void await_rotors(const GuidanceContext& context) {
  const bool on_ground = context.lift_off_ns == 0 || context.lift_off_ns > context.now_ns;
  if (context.rotors_running || context.state.phase != Phase::kSpoolUp || !on_ground) return;
  context.state.phase_since_ns = std::max(context.state.phase_since_ns, context.now_ns + 1);
}

double spool_up_lift(const GuidanceContext& context) {
  const double elapsed = elapsed_s(context.state.phase_since_ns, context.now_ns);
  if (context.lift_off_ns == 0) return kSpoolUpLift * std::min(1.0, elapsed / kSpoolUp_s);
  const double slow_s = elapsed - kFastLift_s;
  return slow_s < 0.0 ? kFastLift * elapsed / kFastLift_s
                      : std::min(kFastLift + lift_rate(context) * slow_s, kMostLift);
}

}  // namespace swiftlet::control
