#include "swiftlet/control/supervision/hover_test.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/LU>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Axes3 = Eigen::Array<bool, 3, 1>;

constexpr double kMemory_s = 0.5;       // of the comparisons
constexpr double kRateMemory_s = 0.15;  // of angular accelerations
constexpr double kTurnMemory_s = 0.5;   // of turns
constexpr double kWayMemory_s = 0.5;    // of ways
constexpr double kSmooth_s = 0.02;      // of rates and thrusts
constexpr double kRateFloor = 0.01;     // rad/s
constexpr double kTurnFloor_rad = 4e-3;
constexpr double kWayFloor_m = 1e-3;
constexpr double kBias = 0.04;    // m/s^2, of the accelerometer and of gravity in a tilted estimate
constexpr double kWrong = 0.6;    // misfit of an axis that does not show what is expected
constexpr double kFits = 0.3;     // of one that does
constexpr double kRight = 0.05;   // of one whose sensor is right beyond doubt
constexpr double kLikely = 1.0;   // of all axes of rotors that must be named now
constexpr double kChange = 0.02;  // a hypothesis with one more change must fit better by this

// One that has tilted by so much so soon after lift-off turns over a foot, not on command.
constexpr double kTips_s = 0.06;
constexpr double kTips_rad = 0.02;
constexpr double kClear_m = 0.004;   // above the ground
constexpr double kShown_s = 0.04;    // clear of the ground: before, the feet turn the vehicle
constexpr double kJudged_s = 0.18;   // from lift-off, unless a limit is reached before
constexpr double kDecided_s = 0.23;  // from then on, what is known must do
constexpr double kCompared_s = 1.0;  // from lift-off: later, biases show more than motion
constexpr double kMostTilt_rad = 0.35;
constexpr double kMostRate = 5.0;      // rad/s
constexpr double kMostDrift_m = 0.12;  // from where it stood
constexpr double kMostHeight_m = 0.18;
constexpr double kMostSpeed = 0.5;    // m/s
constexpr double kLeastThrust = 0.7;  // of that of the vehicle file
constexpr double kMostThrust = 1.4;
constexpr double kLeastUnexplained = 0.5;  // rad/s
constexpr double kAlong = 0.9;             // cosine between the turn and that of a rotor without thrust

const char* const kBodyAxes[3] = {"roll", "pitch", "yaw"};
const char* const kWorldAxes[3] = {"north", "east", "down"};

// An assignment of axes: axis i shows the axis order[i], with a sign.
struct Axes {
  std::array<int, 3> order{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};

  Matrix3d gain() const {
    Matrix3d gain = Matrix3d::Zero();
    for (int i = 0; i < 3; ++i)
      gain(i, order[static_cast<std::size_t>(i)]) = sign[static_cast<std::size_t>(i)];
    return gain;
  }
  int changes() const {
    int count = 0;
    for (std::size_t i = 0; i < 3; ++i) count += (order[i] != static_cast<int>(i)) + (sign[i] < 0);
    return count;
  }
};

// The assignment with the least misfit.
Axes best_axes(const AxisResponse<3>& response, double& misfit) {
  Axes best;
  double least = std::numeric_limits<double>::infinity();
  Axes tried;
  do {
    for (int signs = 0; signs < 8; ++signs) {
      for (std::size_t i = 0; i < 3; ++i) tried.sign[i] = (signs >> i & 1) != 0 ? -1 : 1;
      const double of_this = response.misfit(tried.gain()).maxCoeff();
      if (of_this + kChange * tried.changes() >= least) continue;
      least = of_this + kChange * tried.changes();
      misfit = of_this;
      best = tried;
    }
  } while (std::next_permutation(tried.order.begin(), tried.order.end()));
  return best;
}

Vector3d rotation_vector(const Eigen::Quaterniond& q) {
  const Eigen::AngleAxisd turn(q);
  return turn.angle() * turn.axis();
}

}  // namespace

HoverTest::HoverTest(const plant::Vehicle& vehicle)
    : thrust_per_square_(vehicle.rotor.thrust),
      rotors_(vehicle.rotor_count()),
      rotor_response_(kMemory_s),
      turn_response_(kMemory_s),
      way_response_(kMemory_s) {
  acceleration_per_thrust_.setZero();
  acceleration_per_thrust_.leftCols(rotors_) =
      vehicle.inertia.inverse() * plant::effectiveness(vehicle).bottomRows<3>();
}

void HoverTest::reset() {
  if (!begun_) return;
  defect_ = {};
  begun_ = false;
  tips_ = clear_ = false;
  clear_s_ = 0.0;
  lifted_off_s_ = 0.0;
  rotor_response_ = RotorResponse(kMemory_s);
  turn_response_ = BodyResponse(kMemory_s);
  way_response_ = BodyResponse(kMemory_s);
  turn_ = speed_ned_ = way_ned_ = turn_by_gyro_ = turn_by_pose_ = Vector3d::Zero();
  motion_count_ = 0;
  has_pose_ = false;
}

void HoverTest::begin(const HoverTestStep& now) {
  reset();
  begun_ = true;
  up_frd_ = now.q_ned_from_frd.conjugate() * Vector3d::UnitZ();
  start_ned_ = now.position_ned;
  begin_rates(now);
  noise_.setZero();
  unexplained_.setZero();
}

void HoverTest::step(const HoverTestStep& now) {
  if (!begun_) begin(now);
  if (defect_[0] != '\0') return;
  commands_rotors_ = now.commands_rotors;
  add_rotors(now);
  if (now.lifted_off) {
    lifted_off_s_ += now.dt_s;
    tips_ = tips_ || (lifted_off_s_ < kTips_s && tilt(now) > kTips_rad);
    add_motion(now);
    judge_lift(now);
    if (lifted_off_s_ > kJudged_s && lifted_off_s_ < kCompared_s && !tips_ && defect_[0] == '\0')
      judge(lifted_off_s_ > kDecided_s);
  }
  judge_limits(now);
}

// The rates after the high pass s / (s + 1 / kRateMemory_s) are leaky integrals of the angular acceleration, and so are the
// thrusts of the rotors here. Both pass the same low pass, against vibration.
void HoverTest::add_rotors(const HoverTestStep& now) {
  if (!clear_ && -way_ned_.z() > kClear_m) {
    clear_ = true;
    begin_rates(now);
  }
  const double part = now.dt_s / (kRateMemory_s + now.dt_s);
  const double smooth = now.dt_s / (kSmooth_s + now.dt_s);
  RotorResponse::Inputs thrusts = RotorResponse::Inputs::Zero();
  for (int i = 0; i < rotors_; ++i) {
    const double speed = now.rotor_speeds[static_cast<std::size_t>(i)];
    thrusts[i] = thrust_per_square_ * speed * speed;
  }
  thrusts[kInputs - 1] = 1.0;
  thrusts_ += now.dt_s * (thrusts - thrusts_ / kRateMemory_s);
  slow_rates_ += part * (now.body_rates_frd - slow_rates_);
  smooth_thrusts_ += smooth * (thrusts_ - smooth_thrusts_);
  smooth_rates_ += smooth * (now.body_rates_frd - slow_rates_ - smooth_rates_);
  // Two samples differ by twice the variance of white noise, of which the low pass leaves smooth / (2 - smooth).
  const Vector3d change = now.body_rates_frd - last_rates_;
  last_rates_ = now.body_rates_frd;
  noise_ += part * (0.5 * change.cwiseAbs2() - noise_);
  unexplained_ = smooth_rates_ - acceleration_per_thrust_ * smooth_thrusts_.head<plant::kMaxRotors>();
  if (!clear_) return;
  clear_s_ += now.dt_s;
  if (!now.commands_rotors) return;
  const Vector3d floor = (noise_ * smooth / (2.0 - smooth)).cwiseSqrt().array() + kRateFloor;
  rotor_response_.add(now.dt_s, smooth_thrusts_, smooth_rates_, floor);
}

// From how the vehicle stood.
double HoverTest::tilt(const HoverTestStep& now) const {
  const Vector3d up_frd = now.q_ned_from_frd.conjugate() * Vector3d::UnitZ();
  return std::acos(std::clamp(up_frd.dot(up_frd_), -1.0, 1.0));
}

void HoverTest::begin_rates(const HoverTestStep& now) {
  thrusts_.setZero();
  smooth_thrusts_.setZero();
  smooth_rates_.setZero();
  slow_rates_ = last_rates_ = now.body_rates_frd;
}

// The way passes the high pass s^2 / (s + 1 / kWayMemory_s)^2.
void HoverTest::add_motion(const HoverTestStep& now) {
  turn_ += now.dt_s * now.body_rates_frd;
  const Vector3d acceleration_ned =
      now.q_ned_from_frd * now.specific_force_frd + plant::kGravity * Vector3d::UnitZ();
  speed_ned_ += now.dt_s * (acceleration_ned - (2.0 * speed_ned_ + way_ned_ / kWayMemory_s) / kWayMemory_s);
  way_ned_ += now.dt_s * speed_ned_;
  motions_[motion_count_++ % motions_.size()] = {now.stamp_ns, turn_, way_ned_};
}

const HoverTest::Motion* HoverTest::motion_at(std::int64_t stamp_ns) const {
  for (std::size_t back = 1; back <= std::min(motion_count_, motions_.size()); ++back) {
    const Motion& motion = motions_[(motion_count_ - back) % motions_.size()];
    if (motion.stamp_ns <= stamp_ns) return &motion;
  }
  return nullptr;
}

void HoverTest::on_pose(const plant::PoseSample& pose) {
  if (!begun_ || !pose.tracked || (has_pose_ && pose.stamp_ns <= pose_.stamp_ns)) return;
  const Motion* const motion = motion_at(pose.stamp_ns);
  if (!has_pose_ || motion == nullptr) {
    pose_ = pose;
    has_pose_ = motion != nullptr;
    if (motion == nullptr) return;
    at_pose_ = *motion;
    slow_ned_ = pose.position_ned;
    slow_once_ned_.setZero();
    return;
  }
  const double dt_s = math::seconds(pose.stamp_ns - pose_.stamp_ns);
  const double kept = kTurnMemory_s / (kTurnMemory_s + dt_s);
  turn_by_gyro_ = kept * (turn_by_gyro_ + motion->turn - at_pose_.turn);
  turn_by_pose_ =
      kept * (turn_by_pose_ + rotation_vector(pose_.q_ned_from_frd.conjugate() * pose.q_ned_from_frd));
  turn_response_.add(dt_s, turn_by_gyro_, turn_by_pose_, Vector3d::Constant(kTurnFloor_rad));
  const double part = dt_s / (kWayMemory_s + dt_s);
  slow_ned_ += part * (pose.position_ned - slow_ned_);
  const Vector3d once_ned = pose.position_ned - slow_ned_;
  slow_once_ned_ += part * (once_ned - slow_once_ned_);
  const double known_s = std::min(lifted_off_s_, kWayMemory_s);
  const double floor_m = kWayFloor_m + 0.5 * kBias * known_s * known_s;
  way_response_.add(dt_s, motion->way_ned, once_ned - slow_once_ned_, Vector3d::Constant(floor_m));
  pose_ = pose;
  at_pose_ = *motion;
}

// The lift is learnt at lift-off.
void HoverTest::judge_lift(const HoverTestStep& now) {
  if (now.lift_ratio <= kMostThrust && now.lift_ratio >= kLeastThrust) return;
  std::snprintf(defect_.data(), defect_.size(),
                "the rotors give %.1f times the thrust of the vehicle file, or its mass is wrong",
                now.lift_ratio);
}

// Rotors against gyro, gyro against poses: the one that disagrees with both others is wrong. Waits until the axes that disagree
// have moved enough for both; not if it is the last time.
void HoverTest::judge(bool last) {
  std::array<int, plant::kMaxRotors> as_numbered{};
  std::iota(as_numbered.begin(), as_numbered.end(), 0);
  const RotorResponse::Gain as_filed = rotor_gain(as_numbered, 1.0);
  RotorResponse rotors = rotor_response_;
  rotors.take_out(kInputs - 1);
  const Axes3 wrong_by_rotors = rotors.misfit(as_filed).array() > kWrong;
  const Axes3 right_by_rotors = rotors.misfit(as_filed).array() < kRight && rotors.moves(as_filed);
  const Axes3 wrong_by_poses = turn_response_.misfit(Matrix3d::Identity()).array() > kWrong;
  const bool rotors_wrong = commands_rotors_ && wrong_by_rotors.any();
  if (wrong_by_poses.any()) {
    const bool known = rotors_wrong || (wrong_by_poses <= right_by_rotors).all() ||
                       (last && (wrong_by_poses && right_by_rotors).any());
    const char* const subject = !known         ? "gyro or attitude of motion capture"
                                : rotors_wrong ? "gyro"
                                               : "attitude of motion capture";
    if (known || last || !commands_rotors_) name_axes(subject, turn_response_, kBodyAxes);
  } else if (rotors_wrong) {
    if (last || (wrong_by_rotors <= turn_response_.moves(Matrix3d::Identity())).all()) name_rotors(last);
  } else if (way_response_.misfit(Matrix3d::Identity()).maxCoeff() > kWrong) {
    name_axes("position of motion capture", way_response_, kWorldAxes);
  }
}

// order[i]: the place in the vehicle file at which rotor i turns. spin: -1 if all turn the other way.
HoverTest::RotorResponse::Gain HoverTest::rotor_gain(const std::array<int, plant::kMaxRotors>& order,
                                                     double spin) const {
  RotorResponse::Gain gain = RotorResponse::Gain::Zero();
  for (int i = 0; i < rotors_; ++i) {
    gain.col(i) = acceleration_per_thrust_.col(order[static_cast<std::size_t>(i)]);
    gain(2, i) *= spin;
  }
  return gain;
}

// The hypothesis with the least sum of misfits. A constant moment is small beside that of a rotor without thrust.
void HoverTest::name_rotors(bool last) {
  double least = last ? kLikely : kFits;
  char text[sizeof(VehicleFault)] = "";
  const auto compare = [&](const std::array<int, plant::kMaxRotors>& order, double spin, double penalty,
                           const char* format, int a, int b) {
    const double misfit = rotor_response_.misfit(rotor_gain(order, spin)).sum() + penalty;
    if (misfit >= least) return;
    least = misfit;
    const int used = std::snprintf(text, sizeof text, format, a, b);
    if (spin < 0.0)
      std::snprintf(text + used, sizeof text - static_cast<std::size_t>(used),
                    "all rotors turn the other way than in the vehicle file");
  };
  std::array<int, plant::kMaxRotors> order{};
  std::iota(order.begin(), order.end(), 0);
  compare(order, -1.0, 0.0, "", 0, 0);
  for (int i = 0; i < rotors_; ++i) {
    RotorResponse::Gain without = rotor_gain(order, 1.0);
    without.col(i).setZero();
    const double misfit = rotor_response_.misfit(without).sum();
    if (misfit >= least) continue;
    least = misfit;
    std::snprintf(text, sizeof text, "rotor %d gives too little thrust", i + 1);
  }
  for (const double spin : {1.0, -1.0}) {
    const double penalty = spin < 0.0 ? 5.0 * kChange : 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(rotors_); ++i) {
      for (std::size_t j = i + 1; j < static_cast<std::size_t>(rotors_); ++j) {
        std::swap(order[i], order[j]);
        compare(order, spin, penalty,
                spin < 0.0 ? "rotors %d and %d are exchanged, and " : "rotors %d and %d are exchanged",
                static_cast<int>(i) + 1, static_cast<int>(j) + 1);
        std::swap(order[i], order[j]);
      }
    }
    for (int by = 1; by < rotors_; ++by) {
      std::rotate(order.begin(), order.begin() + 1, order.begin() + rotors_);
      compare(order, spin, penalty + kChange,
              spin < 0.0 ? "rotor 1 is at the place of rotor %d, and so on, and "
                         : "rotor 1 is at the place of rotor %d, and so on",
              by + 1, 0);
    }
    std::rotate(order.begin(), order.begin() + 1, order.begin() + rotors_);
  }
  name(text);
}

void HoverTest::name_axes(const char* subject, const BodyResponse& response, const char* const (&axes)[3]) {
  if (response.misfit(Matrix3d::Zero()).maxCoeff() < kFits)
    return name("motion capture does not show the motion: it tracks another body");
  double misfit = 0.0;
  const Axes found = best_axes(response, misfit);
  if (misfit > kFits) return;
  int used = std::snprintf(defect_.data(), defect_.size(), "%s: ", subject);
  bool first = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool exchanged = found.order[i] != static_cast<int>(i);
    if (!exchanged && found.sign[i] > 0) continue;
    char text[32];
    std::snprintf(text, sizeof text, exchanged ? "%s shows %s%s" : "%s is reversed", axes[i],
                  found.sign[i] < 0 ? "-" : "", axes[static_cast<std::size_t>(found.order[i])]);
    const auto at = static_cast<std::size_t>(used);
    used += std::snprintf(defect_.data() + at, defect_.size() - at, "%s%s", first ? "" : ", ", text);
    first = false;
  }
}

void HoverTest::judge_limits(const HoverTestStep& now) {
  const Vector3d from_start = now.position_ned - start_ned_;
  const char* fault = nullptr;
  if (tilt(now) > kMostTilt_rad) fault = "it tilts too far";
  if (now.body_rates_frd.norm() > kMostRate) fault = "it turns too fast";
  if (from_start.head<2>().norm() > kMostDrift_m) fault = "it drifts away";
  if (now.ground_z_ned - now.position_ned.z() > kMostHeight_m || -now.velocity_ned.z() > kMostSpeed)
    fault = "it climbs too far";
  if (fault == nullptr || defect_[0] != '\0') return;
  if (clear_s_ > kShown_s && !tips_) judge(true);
  if (defect_[0] != '\0') return;
  name_weak_rotor();
  if (defect_[0] == '\0') name(fault);
}

// A rotor that gives too little leaves an angular acceleration that is opposite to its own.
void HoverTest::name_weak_rotor() {
  if (!commands_rotors_ || unexplained_.head<2>().norm() < kLeastUnexplained) return;
  for (int i = 0; i < rotors_; ++i) {
    const Vector3d missing = -acceleration_per_thrust_.col(i);
    const double along = unexplained_.head<2>().dot(missing.head<2>().normalized());
    if (along < kAlong * unexplained_.head<2>().norm()) continue;
    std::snprintf(defect_.data(), defect_.size(),
                  "rotor %d gives too little thrust, or the vehicle is too heavy on its side", i + 1);
    return;
  }
}

void HoverTest::name(const char* text) { std::snprintf(defect_.data(), defect_.size(), "%s", text); }

}  // namespace swiftlet::control
