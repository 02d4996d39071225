// What can be wrong with a stream of poses that one pose alone does not show: frozen markers, and steps. q and -q
// are one attitude.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::control {

// Recognises a stream that says the same again and again. A vehicle that moves while its pose does not gives
// it away, once the innovation contradicts. In hover nothing contradicts, but noise does not repeat: a stream
// that never did while the vehicle stood with its rotors off is frozen when it does. A stream without noise
// repeats from the start and is not judged by that.
class StuckPoseDetector {
 public:
  explicit StuckPoseDetector(const StuckPoseSettings& settings = {}) : settings_(settings) {}

  void look_at(const plant::PoseSample& pose, plant::RotorState rotors);

  // The newest pose is the one before it.
  bool repeats() const { return repetitions_ > 0; }
  // It has been the same for so long as noise never is.
  bool frozen() const { return noisy_ && repetitions_ >= settings_.repetitions; }

 private:
  StuckPoseSettings settings_;
  plant::PoseSample last_;
  int repetitions_ = 0;
  int distinct_ = 0;  // in a row, with the rotors off
  bool noisy_ = false;
};

// Whether a stream goes on without a break, as the pose of a body does that moves. What leads from a pose to
// the next faster than a body moves is a step: from there on the stream shows something else, until the way
// back leads to where the body can be again.
class PoseContinuity {
 public:
  explicit PoseContinuity(const EstimatorSettings& settings = {})
      : settings_(settings.detectors.continuity),
        max_speed_(settings.max_speed),
        max_body_rate_(settings.max_body_rate) {}

  void look_at(const plant::PoseSample& pose);
  // The newest pose agrees with the estimate: from here on.
  void begin() {
    unbroken_ = true;
    in_reach_ = true;
    rejected_ = false;
    stepped_ned_.setZero();
    turned_frd_.setIdentity();
  }
  void end() { unbroken_ = false; }
  // The stream shows something else, and a gap has hidden how it came to that: with the next step it may show
  // the body again.
  void reject_track() {
    rejected_ = true;
    unbroken_ = false;
  }

  // The steps since begin() have led back, or there were none: a body could have gone the way, also where
  // poses are missing.
  bool in_reach() const { return in_reach_; }
  // In reach since begin(), steps that led away and back left out, and without a gap in which one would not
  // be seen.
  bool unbroken() const { return unbroken_ && in_reach_; }
  // The newest poses go on from one to the next: for settings.lasting_poses and settings.lasting_s at least.
  bool lasting() const { return poses_ >= settings_.lasting_poses && lasted_s() >= settings_.lasting_s; }
  int poses() const { return poses_; }               // in a row that do
  double interval_s() const { return interval_s_; }  // between the newest two
  // Between the newest pose and that of kSpan poses before, m/s.
  Eigen::Vector3d velocity_ned() const;

  static constexpr std::size_t kSpan = 4;

 private:
  double lasted_s() const { return 1e-9 * static_cast<double>(before(0).stamp_ns - since_ns_); }
  const plant::PoseSample& before(std::uint64_t count) const {
    return last_[(next_ - 1 - count) % last_.size()];
  }

  PoseContinuitySettings settings_;
  double max_speed_;      // m/s
  double max_body_rate_;  // rad/s

  bool unbroken_ = false;
  bool in_reach_ = false;
  bool rejected_ = false;
  // All steps since begin(), one after the other.
  Eigen::Vector3d stepped_ned_ = Eigen::Vector3d::Zero();  // m
  Eigen::Quaterniond turned_frd_ = Eigen::Quaterniond::Identity();
  int poses_ = 0;
  std::int64_t since_ns_ = 0;
  double interval_s_ = 0.0;
  std::array<plant::PoseSample, kSpan + 1> last_;
  std::uint64_t next_ = 0;  // of all that came
};

}  // namespace swiftlet::control
