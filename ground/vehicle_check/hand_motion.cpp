#include "swiftlet/ground/vehicle_check/hand_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "swiftlet/ground/vehicle_check/axes.hpp"
#include "swiftlet/ground/vehicle_check/checks.hpp"
#include "swiftlet/ground/vehicle_check/rate_tracks.hpp"
#include "swiftlet/ground/vehicle_check/standing_vehicle.hpp"
#include "swiftlet/math/angles.hpp"
#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kLeastTurn_rad = 0.25;
constexpr double kLeastForce = 0.2;  // of gravity: a tilt of 12 degrees
constexpr double kLeastMove_m = 0.1;
constexpr double kMoveClearness = 0.8;  // cosine to the asked direction
constexpr double kLongestDelay_s = 0.2;
constexpr double kLeastCorrelation = 0.8;
constexpr double kLeastWave_rad_s = 1.0;  // root mean square

// A hand cannot turn or jerk a vehicle by this much from one sample to the next.
constexpr double kGyroStep_rad_s = 3.0;
constexpr double kForceStep_m_s2 = 60.0;
constexpr double kNearTheEnd = 0.6;  // of the largest value: both sides of an overflow lie there
constexpr int kSaturated = 5;        // samples in a row at the largest value

constexpr const char* kUnseen = "missing: motion capture does not see the vehicle in this step";

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

CheckResult check_axes(const char* subject, const std::string& sensor, const std::optional<AxisMap>& map,
                       const Eigen::Matrix3d& responses) {
  const Eigen::Vector3d along = responses.diagonal();
  const std::string defect = map ? describe(*map) : "";
  std::string finding = defect.empty() ? "" : "{sensor}: {defect}";
  if (!map)
    finding = "the motions do not show the axes of the {sensor} clearly: repeat them, one axis at a time";
  return judge_by(
      kHandAxes, along.minCoeff(), finding,
      {{"subject", subject}, {"along", to_string(along, 2)}, {"sensor", sensor}, {"defect", defect}});
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

CheckResult check_scale(const Turns& turns) {
  const double by_mocap = turns.mocap.colwise().norm().sum();
  if (by_mocap < kLeastTurn_rad)
    return missing(kGyroScale.name, "missing: motion capture shows no turn to compare with");
  return judge(kGyroScale, turns.gyro.colwise().norm().sum() / by_mocap);
}

// moved: by the vehicle; nearly all of it should be along. The sentences name no move, one to the other side, and one
// to another side.
CheckResult check_move(const Check& check, const Eigen::Vector3d& moved, double along, const char* none,
                       const char* reversed, const char* aside) {
  const double size = moved.norm();
  const double cosine = along / size;
  const char* finding = cosine >= kMoveClearness ? "" : cosine <= -kMoveClearness ? reversed : aside;
  if (size < kLeastMove_m) finding = none;
  return judge_by(check, size, finding,
                  {{"moved", to_string(moved, 2)}, {"direction", to_string(moved.normalized(), 2)}});
}

CheckResult check_forward(const std::optional<Displacement>& moved) {
  if (!moved) return missing(kHandForward.name, kUnseen);
  return check_move(kHandForward, moved->position_begin_frd, moved->position_begin_frd.x(),
                    "motion capture shows no move along the nose: wrong unit, or another body",
                    "motion capture: the vehicle moves backwards when carried along its nose",
                    "motion capture: carried along its nose it moves to {direction} in body axes: position "
                    "and attitude are in different frames, such as ENU and NED, or the marker body's yaw is "
                    "misaligned");
}

CheckResult check_up(const std::optional<Displacement>& moved) {
  if (!moved) return missing(kHandUp.name, kUnseen);
  return check_move(kHandUp, moved->position_ned, -moved->position_ned.z(),
                    "motion capture shows no move upwards: wrong unit, or another body",
                    "motion capture in ENU: z rises when the vehicle is lifted, expected NED",
                    "motion capture: lifted, the vehicle moves sideways to {direction}: axes swapped, y up?");
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
  const Words words = {{"correlation", delay.correlation}};
  if (delay.correlation >= kLeastCorrelation) return judge(kHandDelay, 1e3 * delay.delay_s, words);
  return judge_by(
      kHandDelay, 1e3 * delay.delay_s,
      "gyro and motion capture do not show the same motion: another body, or one of them is wrong", words);
}

CheckResults check_wave(const VehicleRecording& wave, const VehicleRecording& rest,
                        const std::optional<AxisMap>& gyro_map, const std::optional<AxisMap>& mocap_map) {
  const GyroTrack gyro(wave, mean_body_rates(rest));
  const std::vector<MocapRate> mocap = mocap_rates(wave);
  double square = 0.0;
  for (const MocapRate& rate : mocap) square += rate.body_rates_frd.squaredNorm();
  if (mocap.empty()) return {missing(kHandDelay.name, kUnseen)};
  if (std::sqrt(square / static_cast<double>(mocap.size())) < kLeastWave_rad_s)
    return {missing(kHandDelay.name, "missing: the turns about all axes were too slow; repeat them quicker")};
  const Delay delay = find_delay(gyro, mocap, kLongestDelay_s);
  CheckResults results = {check_delay(delay)};
  if (!gyro_map || !mocap_map || delay.correlation < kLeastCorrelation) {
    results.push_back(skipped(kHandAlignment.name, "the axes of gyro and motion capture are not clear"));
    return results;
  }
  std::vector<RatePair> pairs;
  const std::int64_t delay_ns = math::nanoseconds(delay.delay_s);
  for (const MocapRate& rate : mocap) {
    if (const auto mean = gyro.mean(rate.from_ns - delay_ns, rate.to_ns - delay_ns))
      pairs.push_back(
          {gyro_map->matrix().transpose() * *mean, mocap_map->matrix().transpose() * rate.body_rates_frd});
  }
  results.push_back(judge(kHandAlignment, misalignment_deg(pairs)));
  return results;
}

struct Axis {
  std::string name;  // "gyro x"
  const char* unit;
  double step;  // no motion of a hand
  std::vector<double> values;
};

std::vector<Axis> axes_of(const VehicleRecording& recording) {
  std::vector<Axis> axes;
  for (Eigen::Index i = 0; i < 3; ++i) {
    axes.push_back({std::string("gyro ") + "xyz"[i], "rad/s", kGyroStep_rad_s, {}});
    for (const auto& received : recording.imu.samples)
      axes.back().values.push_back(received.sample.imu.body_rates_frd(i));
    axes.push_back({std::string("accelerometer ") + "xyz"[i], "m/s^2", kForceStep_m_s2, {}});
    for (const auto& received : recording.imu.samples)
      axes.back().values.push_back(received.sample.imu.specific_force_frd(i));
  }
  return axes;
}

double largest(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

std::size_t overflows(const Axis& axis) {
  const double end = kNearTheEnd * largest(axis.values);
  std::size_t count = 0;
  for (std::size_t i = 1; i < axis.values.size(); ++i) {
    const double before = axis.values[i - 1];
    const double now = axis.values[i];
    if (before * now < 0.0 && std::abs(now - before) > axis.step && std::abs(before) > end &&
        std::abs(now) > end)
      ++count;
  }
  return count;
}

std::size_t is_saturated(const Axis& axis) {
  const double most = largest(axis.values);
  if (2.0 * most < axis.step) return 0;  // too small to tell from a sensor at rest
  int in_a_row = 0;
  for (const double value : axis.values) {
    in_a_row = std::abs(value) == most ? in_a_row + 1 : 0;
    if (in_a_row >= kSaturated) return 1;
  }
  return 0;
}

// Names the first axis with a fault.
CheckResult check_range(const Check& check, const std::vector<Axis>& axes,
                        std::size_t (*faults)(const Axis&)) {
  std::size_t total = 0;
  const Axis* faulty = &axes.front();
  for (const Axis& axis : axes) {
    const std::size_t count = faults(axis);
    if (count > 0 && total == 0) faulty = &axis;
    total += count;
  }
  return judge(check, static_cast<double>(total),
               {{"axis", faulty->name}, {"end", largest(faulty->values)}, {"unit", faulty->unit}});
}

// The range of the IMU over fast motion: overflow of 16-bit values and saturation.
CheckResults check_imu_range(const VehicleRecording& recording) {
  if (recording.imu.samples.empty()) return {missing(kWrapAround.name, "missing: no imu message arrived")};
  const std::vector<Axis> axes = axes_of(recording);
  return {check_range(kWrapAround, axes, overflows), check_range(kSaturation, axes, is_saturated)};
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
  CheckResults results = {check_axes("gyro", "gyro", gyro_map, turns.gyro),
                          check_axes("accelerometer", "accelerometer", force_map, turns.force),
                          check_axes("mocap_attitude", "motion capture attitude", mocap_map, turns.mocap),
                          check_scale(turns),
                          check_forward(displacement(recording, *segment_of(segments, HandStep::kForward))),
                          check_up(displacement(recording, *segment_of(segments, HandStep::kUp)))};
  append(results, check_wave(wave, rest, gyro_map, mocap_map));
  append(results, check_imu_range(wave));
  return results;
}

}  // namespace swiftlet::ground
