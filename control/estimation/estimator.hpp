// State estimator: position, velocity, attitude, gyro bias and accelerometer bias from IMU and motion
// capture.
//
// An error-state Kalman filter with the attitude error in the world frame (Sola 2017, arXiv:1711.02508;
// error_covariance.hpp has F, H, Q, V and K; README.md lists the detectors). Each IMU sample propagates the
// nominal state. The covariance stays at the stamp of the last pose. A pose is compared with the estimate at
// the pose's own stamp: the covariance is propagated to it, and the correction is propagated to the present
// through the stored history. So latency does not destabilise the filter.
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/estimation/error_covariance.hpp"
#include "swiftlet/control/estimation/pose_imu_consistency.hpp"
#include "swiftlet/control/estimation/pose_stream.hpp"
#include "swiftlet/control/estimation/state_history.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::control {

// Why the newest pose was not used.
enum class PoseFault : std::uint8_t {
  kNone = 0,       // it was used
  kUntracked = 1,  // the motion capture system reports it as not tracked
  kInvalid = 2,    // not finite, or not a unit quaternion
  kUntimely = 3,   // not newer than the last, older than the history, or ahead of the IMU
  kOutlier = 4,    // too far from the estimate
  kSwapped = 5,    // rotated from the estimate by more than any gyro error: swapped markers, another vehicle
  kFrozen = 6,     // the pose repeats
};
const char* to_string(PoseFault fault);

struct Estimate {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();  // m/s
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();      // rad/s, bias removed
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           // rad/s
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  // m/s^2, in FRD

  PoseFault pose_fault = PoseFault::kNone;
  std::uint64_t poses_accepted = 0;
  std::uint64_t poses_refused = 0;
  // Number of resets to poses that disagreed with the estimate for long, and the change of position and yaw
  // at the last one. A reference that is to keep its place in the room must be moved by the same amount.
  std::uint32_t resets = 0;
  Eigen::Vector3d reset_position_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d reset_rotation_ned = Eigen::Vector3d::Zero();  // rad, a rotation vector
};

// Means of the motion between two samples.
struct MeanMotion {
  Eigen::Vector3d specific_force_frd = Eigen::Vector3d::Zero();  // m/s^2
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();      // rad/s
};

class Estimator {
 public:
  explicit Estimator(const EstimatorSettings& settings);

  // Propagates the estimate to the sample. Returns false, and changes nothing, for a sample that is not
  // finite or not newer than the last. A gap in the samples is bridged with the mean rates and specific
  // force of the samples around it, and the motion that it may hide is added to the covariance.
  bool predict(const plant::ImuSample& sample);
  // The same with known means since the last sample, in place of those of its end points.
  bool predict(const plant::ImuSample& sample, const MeanMotion& mean);

  // Fuses a pose. Returns false for a refused one: pose_fault then has the reason, and nothing else of the
  // estimate changes. A pose with the stamp of the last one is a duplicate and is ignored.
  //
  // Gate: an innovation beyond the chi-square gate, but short of an outlier, is scaled down to the gate and
  // does not reduce the covariance, so a glitch moves the estimate no faster than noise would. If the next
  // poses contradict too, the cause is a motion or step that the noise densities do not cover: variance of
  // its size is added to position, velocity and attitude, so that these follow the poses while the biases
  // hardly change.
  //
  // Outliers are refused. In flight the estimate resets to them once a continuous stream has lasted: it must
  // have been continuous since it last agreed, so the IMU was wrong or silent. A stream with a step that no
  // body can make is taken for another body until it steps back. A motion that an IMU silence hides is
  // accepted once the IMU agrees with the motion of the poses since. With rotors off, any stream that lasts
  // is accepted.
  bool correct(const plant::PoseSample& pose, plant::RotorState rotors = plant::RotorState::kRunning);

  // True once a pose was fused. Before that the estimate has no meaning.
  bool initialised() const { return initialised_; }
  const Estimate& estimate() const { return now_; }
  // From the exposure of the last fused pose to the estimate's stamp; infinite before the first.
  double pose_age_s() const;
  std::uint64_t pose_sequence() const { return pose_sequence_; }

  // Standard deviation of the estimate's error at its stamp; infinite before the first pose. Takes some
  // microseconds at most: for telemetry.
  ErrorState standard_deviation() const { return covariance().standard_deviation(); }
  ErrorCovariance covariance() const;
  // Normalised innovation squared of the last pose that was compared: chi-square with 6 degrees of freedom.
  double normalised_innovation() const { return normalised_innovation_; }

 private:
  bool is_usable(const plant::ImuSample& sample) const;
  void start_at(const plant::PoseSample& pose);
  void publish();
  PoseFault fuse(const plant::PoseSample& pose, plant::RotorState rotors);
  PoseInnovation compare(const plant::PoseSample& pose);
  PoseFault disagree(const plant::PoseSample& pose, const PoseInnovation& innovation,
                     plant::RotorState rotors, bool trusted);
  void accept(const plant::PoseSample& pose);  // ends all disagreement with the stream
  void agree(const PoseInnovation& innovation, const ErrorCovariance::Update& correction);
  ErrorCovariance::Update compute_update(const PoseInnovation& innovation) const;
  double outlier_rotation() const;  // rad
  bool trusted_after_silence(const plant::PoseSample& pose, const PoseInnovation& innovation);
  void apply(const ErrorState& step);
  void restart_at(const plant::PoseSample& pose, const PoseInnovation& innovation);
  // Propagates the covariance, with the motion that an IMU silence may hide.
  void propagate(ErrorCovariance& covariance, const ErrorInterval& interval) const;

  EstimatorSettings settings_;
  DetectorSettings detectors_;  // copy of settings_.detectors
  ErrorNoise noise_;
  Estimate now_;
  plant::ImuSample last_imu_;
  bool initialised_ = false;
  std::int64_t received_stamp_ns_ = 0;  // of the last pose received
  std::int64_t pose_stamp_ns_ = 0;      // of the last pose fused
  std::uint64_t pose_sequence_ = 0;
  double normalised_innovation_ = 0.0;
  StuckPoseDetector stuck_pose_;
  PoseContinuity continuity_;
  bool imu_was_silent_ = false;      // the IMU was silent since the last fused pose ...
  std::int64_t silence_end_ns_ = 0;  // ... until then
  PoseImuConsistencyTest pose_imu_test_;
  int refused_in_a_row_ = 0;
  int contradictions_ = 0;  // in a row, of fused poses

  StateHistory history_;        // before the first pose from an arbitrary start
  ErrorCovariance covariance_;  // at its anchor: the state at the last pose, or a later one
};

}  // namespace swiftlet::control
