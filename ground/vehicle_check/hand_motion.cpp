#include "swiftlet/ground/vehicle_check/hand_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <fmt/core.h>

#include "swiftlet/ground/vehicle_check/axes.hpp"
#include "swiftlet/ground/vehicle_check/imu_range.hpp"
#include "swiftlet/ground/vehicle_check/rate_tracks.hpp"
#include "swiftlet/ground/vehicle_check/rest.hpp"
#include "swiftlet/math/angles.hpp"
#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kLeastTurn_rad = 0.25;
constexpr double kLeastForce = 0.2;  // of gravity: a tilt of 12 degrees
constexpr double kLeastMove_m = 0.1;
constexpr double kMoveClearness = 0.8;  // cosine to the asked direction
constexpr double kScaleTolerance = 0.1;
constexpr double kDelay_s = 0.015;
constexpr double kLongestDelay_s = 0.2;
constexpr double kLeastCorrelation = 0.8;
constexpr double kLeastWave_rad_s = 1.0;  // root mean square

constexpr HandStep kTurns[] = {HandStep::kRollRight, HandStep::kNoseUp, HandStep::kTurnRight};

const HandSegment* segment_of(const std::vector<HandSegment>& segments, HandStep step) {
  const auto found =
      std::find_if(segments.begin(), segments.end(), [&](const HandSegment& it) { return it.step == step; });
  return found == segments.end() ? nullptr : &*found;
}

VehicleRecording part_of(const VehicleRecording& recording, const HandSegment& segment) {
  return part_of(recording, segment.begin_ns, segment.end_ns);
}

// The rest at the begin and at the end of a segment.
VehicleRecording begin_of(const VehicleRecording& recording, const HandSegment& segment) {
  return part_of(recording, segment.begin_ns, segment.begin_ns + math::nanoseconds(kRest_s));
}
VehicleRecording end_of(const VehicleRecording& recording, const HandSegment& segment) {
  return part_of(recording, segment.end_ns - math::nanoseconds(kRest_s), segment.end_ns);
}

// From the pose at the begin of a segment to that at its end.
struct Displacement {
  Eigen::Vector3d position_ned;
  Eigen::Vector3d position_begin_frd;  // in body axes of the begin
  Eigen::Vector3d rotation_frd;
};
std::optional<Displacement> displacement(const VehicleRecording& recording, const HandSegment& segment) {
  const auto begin = last_pose(begin_of(recording, segment));
  const auto end = last_pose(end_of(recording, segment));
  if (!begin || !end) return std::nullopt;
  const Eigen::Vector3d moved_ned = end->position_ned - begin->position_ned;
  return Displacement{moved_ned, begin->q_ned_from_frd.conjugate() * moved_ned,
                      math::rotation_vector(begin->q_ned_from_frd.conjugate() * end->q_ned_from_frd)};
}

std::string map_finding(const std::string& sensor, const std::optional<AxisMap>& map) {
  if (!map)
    return "the motions do not show the axes of the " + sensor + " clearly: repeat them, one axis at a time";
  const std::string defect = describe(*map);
  return defect.empty() ? "" : sensor + ": " + defect;
}

CheckResult judged_map(const std::string& name, const std::string& sensor, const std::optional<AxisMap>& map,
                       const Eigen::Matrix3d& responses) {
  const Eigen::Vector3d along = responses.diagonal();
  return judged(name, {along.minCoeff(), "", "x, y, z to their axes: " + to_string(along, 2)},
                "right axes, positive", map_finding(sensor, map));
}

// Everything that the turns show, column by column: about x, y, z.
struct Turns {
  Eigen::Matrix3d gyro = Eigen::Matrix3d::Zero();   // rad
  Eigen::Matrix3d mocap = Eigen::Matrix3d::Zero();  // rad
  Eigen::Matrix3d force = Eigen::Matrix3d::Zero();  // of gravity
};

// The part of the specific force at the end that is not along that of the begin, over its size.
Eigen::Vector3d tilted_force(const VehicleRecording& recording, const HandSegment& segment) {
  const Eigen::Vector3d before = mean_specific_force(begin_of(recording, segment));
  const Eigen::Vector3d after = mean_specific_force(end_of(recording, segment));
  if (before.norm() < 1e-6) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d along = before.normalized();
  return (after - after.dot(along) * along) / before.norm();
}

// Precondition: all turns are among the segments.
Turns measure_turns(const VehicleRecording& recording, const std::vector<HandSegment>& segments,
                    const VehicleRecording& rest) {
  Turns turns;
  const Eigen::Vector3d bias = mean_body_rates(rest);
  for (int axis = 0; axis < 3; ++axis) {
    const HandSegment& segment = *segment_of(segments, kTurns[axis]);
    turns.gyro.col(axis) = GyroTrack(part_of(recording, segment), bias).total();
    if (const auto moved = displacement(recording, segment)) turns.mocap.col(axis) = moved->rotation_frd;
  }
  // At rest the specific force is (0, 0, -g). Right side down it gains -y, nose up it gains +x.
  turns.force.col(0) = tilted_force(recording, *segment_of(segments, HandStep::kNoseUp));
  turns.force.col(1) = -tilted_force(recording, *segment_of(segments, HandStep::kRollRight));
  turns.force.col(2) = -mean_specific_force(rest).normalized();
  return turns;
}

std::string scale_finding(double scale) {
  const auto is_near = [&](double value) { return std::abs(scale / value - 1.0) < 0.15; };
  if (std::abs(scale - 1.0) <= kScaleTolerance) return "";
  if (is_near(math::kDegPerRad)) return "gyro in degrees/s: it shows 57 times the turn of motion capture";
  if (is_near(1.0 / math::kDegPerRad))
    return "gyro converted to radians twice: it shows 1/57 of the turn of motion capture";
  return fmt::format("gyro has a wrong scale: it shows {:.3g} times the turn of motion capture", scale);
}

CheckResult check_scale(const Turns& turns) {
  const double by_mocap = turns.mocap.colwise().norm().sum();
  if (by_mocap < kLeastTurn_rad)
    return missing("hand.gyro_scale", "missing: motion capture shows no turn to compare with");
  const double scale = turns.gyro.colwise().norm().sum() / by_mocap;
  return judged("hand.gyro_scale", figure(scale, "", 3, " of motion capture"),
                fmt::format("1 +- {:g}", kScaleTolerance), scale_finding(scale));
}

std::string forward_finding(const Displacement& forward) {
  const Eigen::Vector3d& moved = forward.position_begin_frd;
  if (moved.norm() < kLeastMove_m)
    return "motion capture shows no move along the nose: wrong unit, or another body";
  const double cosine = moved.x() / moved.norm();
  if (cosine >= kMoveClearness) return "";
  if (cosine <= -kMoveClearness)
    return "motion capture: the vehicle moves backwards when carried along its nose";
  return fmt::format(
      "motion capture: carried along its nose it moves to {} in body axes: position and attitude are in "
      "different "
      "frames, such as ENU and NED, or the marker body's yaw is misaligned",
      to_string(moved.normalized(), 2));
}

std::string up_finding(const Displacement& up) {
  if (up.position_ned.norm() < kLeastMove_m)
    return "motion capture shows no move upwards: wrong unit, or another body";
  const double cosine = -up.position_ned.z() / up.position_ned.norm();
  if (cosine >= kMoveClearness) return "";
  if (cosine <= -kMoveClearness)
    return "motion capture in ENU: z rises when the vehicle is lifted, expected NED";
  return "motion capture: lifted, the vehicle moves sideways to " +
         to_string(up.position_ned.normalized(), 2) + ": axes swapped, y up?";
}

CheckResult check_move(const char* name, const VehicleRecording& recording, const HandSegment& segment,
                       std::string (*finding)(const Displacement&), Eigen::Vector3d Displacement::*shown,
                       const char* limit) {
  const auto moved = displacement(recording, segment);
  if (!moved) return missing(name, "missing: motion capture does not see the vehicle in this step");
  const Eigen::Vector3d vector = (*moved).*shown;
  return judged(name, {vector.norm(), "m", to_string(vector, 2) + " m"}, limit, finding(*moved));
}

// Rotation that turns the rates of motion capture into those of the gyro with the least squares of the rest (Kabsch).
struct RatePair {
  Eigen::Vector3d gyro;
  Eigen::Vector3d mocap;
};
double misalignment_deg(const std::vector<RatePair>& pairs) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const RatePair& pair : pairs) covariance += pair.gyro * pair.mocap.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0,
                        (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
  const Eigen::Matrix3d turn = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  return math::kDegPerRad * Eigen::AngleAxisd(turn).angle();
}

CheckResult check_delay(const Delay& delay) {
  std::string finding;
  if (delay.correlation < kLeastCorrelation) {
    finding = "gyro and motion capture do not show the same motion: another body, or one of them is wrong";
  } else if (delay.delay_s > kDelay_s) {
    finding = fmt::format(
        "motion capture delayed: its stamps are {:.0f} ms later than the motion; they must be those of the "
        "exposure",
        1e3 * delay.delay_s);
  } else if (delay.delay_s < -kDelay_s) {
    finding = fmt::format("late IMU stamps: they are {:.0f} ms later than the motion, by motion capture",
                          -1e3 * delay.delay_s);
  }
  return judged(
      "hand.delay",
      figure(1e3 * delay.delay_s, "ms", 0,
             fmt::format(" of motion capture behind the gyro, correlation {:.2f}", delay.correlation)),
      fmt::format("+- {:.0f} ms", 1e3 * kDelay_s), finding);
}

CheckResults check_wave(const VehicleRecording& wave, const VehicleRecording& rest,
                        const std::optional<AxisMap>& gyro_map, const std::optional<AxisMap>& mocap_map) {
  const GyroTrack gyro(wave, mean_body_rates(rest));
  const std::vector<MocapRate> mocap = mocap_rates(wave);
  double square = 0.0;
  for (const MocapRate& rate : mocap) square += rate.body_rates_frd.squaredNorm();
  if (mocap.empty())
    return {missing("hand.delay", "missing: motion capture does not see the vehicle in this step")};
  if (std::sqrt(square / static_cast<double>(mocap.size())) < kLeastWave_rad_s)
    return {missing("hand.delay", "missing: the turns about all axes were too slow; repeat them quicker")};
  const Delay delay = find_delay(gyro, mocap, kLongestDelay_s);
  CheckResults results = {check_delay(delay)};
  if (!gyro_map || !mocap_map || delay.correlation < kLeastCorrelation) {
    results.push_back(skipped("hand.alignment", "the axes of gyro and motion capture are not clear"));
    return results;
  }
  std::vector<RatePair> pairs;
  const std::int64_t delay_ns = math::nanoseconds(delay.delay_s);
  for (const MocapRate& rate : mocap) {
    if (const auto mean = gyro.mean(rate.from_ns - delay_ns, rate.to_ns - delay_ns))
      pairs.push_back(
          {gyro_map->matrix().transpose() * *mean, mocap_map->matrix().transpose() * rate.body_rates_frd});
  }
  const double off_deg = misalignment_deg(pairs);
  results.push_back(
      judged("hand.alignment", figure(off_deg, "degrees", 1, " between motion capture and gyro"),
             fmt::format("at most {:g} degrees", kAlignment_deg),
             off_deg <= kAlignment_deg
                 ? ""
                 : fmt::format("motion capture attitude is misaligned by {:.0f} degrees with the IMU: "
                               "align the marker body, or look at the IMU's mounting",
                               off_deg)));
  return results;
}

std::string missing_step(const std::vector<HandSegment>& segments) {
  constexpr std::pair<HandStep, const char*> kSteps[] = {{HandStep::kRollRight, "roll right"},
                                                         {HandStep::kNoseUp, "nose up"},
                                                         {HandStep::kTurnRight, "turn right"},
                                                         {HandStep::kForward, "forward"},
                                                         {HandStep::kUp, "up"},
                                                         {HandStep::kWave, "quick turns"}};
  for (const auto& [step, name] : kSteps) {
    if (segment_of(segments, step) == nullptr) return name;
  }
  return "";
}

}  // namespace

CheckResults check_hand_motion(const VehicleRecording& recording, const std::vector<HandSegment>& segments,
                               const VehicleRecording& rest) {
  if (const std::string step = missing_step(segments); !step.empty())
    return {missing("hand.steps", "missing: the motion \"" + step + "\" was not seen by motion capture")};
  const Turns turns = measure_turns(recording, segments, rest);
  const auto gyro_map = axis_map(turns.gyro, kLeastTurn_rad);
  const auto force_map = axis_map(turns.force, kLeastForce);
  const auto mocap_map = axis_map(turns.mocap, kLeastTurn_rad);
  const VehicleRecording wave = part_of(recording, *segment_of(segments, HandStep::kWave));
  CheckResults results = {
      judged_map("hand.gyro", "gyro", gyro_map, turns.gyro),
      judged_map("hand.accelerometer", "accelerometer", force_map, turns.force),
      judged_map("hand.mocap_attitude", "motion capture attitude", mocap_map, turns.mocap),
      check_scale(turns),
      check_move("hand.mocap_forward", recording, *segment_of(segments, HandStep::kForward), forward_finding,
                 &Displacement::position_begin_frd, "along +x, body axes"),
      check_move("hand.mocap_up", recording, *segment_of(segments, HandStep::kUp), up_finding,
                 &Displacement::position_ned, "along -z, NED")};
  append(results, check_wave(wave, rest, gyro_map, mocap_map));
  append(results, check_imu_range(wave));
  return results;
}

}  // namespace swiftlet::ground
