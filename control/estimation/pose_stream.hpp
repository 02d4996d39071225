// Detectors of faults that only a sequence of poses shows: stuck poses and steps. q and -q are one attitude.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::control {

// Detects a stream whose poses repeat. If the vehicle moves, a repeated pose is stuck as soon as the
// innovation contradicts it. In hover nothing contradicts it, but noise does not repeat: a stream that was
// noisy on the ground with the rotors off is stuck when it repeats. A stream without noise repeats from the
// start, so repetition alone does not reject it.
class StuckPoseDetector {
 public:
  explicit StuckPoseDetector(const StuckPoseSettings& settings = {}) : settings_(settings) {}

  void update(const plant::PoseSample& pose, plant::RotorState rotors);

  // The newest pose equals the one before it.
  bool repeats() const { return repetitions_ > 0; }
  // The stream was noisy, and its poses have repeated longer than noise ever does.
  bool frozen() const { return noisy_ && repetitions_ >= settings_.repetitions; }

 private:
  StuckPoseSettings settings_;
  plant::PoseSample last_;
  int repetitions_ = 0;
  int distinct_ = 0;  // in a row, with the rotors off
  bool noisy_ = false;
};

// Detects steps in a stream of poses. A change from one pose to the next that is faster than a body moves is
// a step. From there on the stream shows something else, until a later step leads back to within the body's
// reach.
class PoseContinuity {
 public:
  explicit PoseContinuity(const EstimatorSettings& settings = {})
      : settings_(settings.detectors.continuity),
        max_speed_(settings.max_speed),
        max_body_rate_(settings.max_body_rate) {}

  void update(const plant::PoseSample& pose);
  // The newest pose agrees with the estimate. Continuity counts from here.
  void begin() {
    unbroken_ = true;
    in_reach_ = true;
    rejected_ = false;
    stepped_ned_.setZero();
    turned_frd_.setIdentity();
  }
  void end() { unbroken_ = false; }
  // Rejects the track: the stream shows something else, and a gap hid the change to it. The next step may
  // lead back to the body.
  void reject_track() {
    rejected_ = true;
    unbroken_ = false;
  }

  // The steps since begin() cancel, or there were none: a body could have made this motion, also across
  // gaps.
  bool in_reach() const { return in_reach_; }
  // In reach since begin() (apart from steps that led away and back), and without a gap that could hide a
  // step.
  bool unbroken() const { return unbroken_ && in_reach_; }
  // The newest poses are continuous, for at least settings.lasting_poses and settings.lasting_s.
  bool lasting() const { return poses_ >= settings_.lasting_poses && lasted_s() >= settings_.lasting_s; }
  int poses() const { return poses_; }               // newest continuous poses
  double interval_s() const { return interval_s_; }  // s between the newest two
  // Mean velocity over the last kSpan pose intervals, m/s.
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
  // Sum of all steps since begin().
  Eigen::Vector3d stepped_ned_ = Eigen::Vector3d::Zero();  // m
  Eigen::Quaterniond turned_frd_ = Eigen::Quaterniond::Identity();
  int poses_ = 0;
  std::int64_t since_ns_ = 0;
  double interval_s_ = 0.0;
  std::array<plant::PoseSample, kSpan + 1> last_;
  std::uint64_t next_ = 0;  // number of poses received
};

}  // namespace swiftlet::control
