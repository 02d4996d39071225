// State estimate: the IMU propagates, mocap corrects. Position, velocity, attitude, gyro and accelerometer
// bias.
//
// An error-state Kalman filter on the attitude manifold, its attitude error taken in the world frame (Sola
// 2017, arXiv:1711.02508; error_covariance.hpp has F, H, Q, V and K). README.md has the detectors. The nominal state goes on with each IMU sample. The
// covariance stays at the last pose's stamp; a pose is compared with the estimate at the pose's own stamp,
// the covariance brought there, and the correction brought forward to now along the kept history, so that
// latency costs no stability.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/estimation/error_covariance.hpp"
#include "swiftlet/control/estimation/pose_imu_consistency.hpp"
#include "swiftlet/control/estimation/pose_stream.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::control {

// Why the newest pose was not used.
enum class PoseFault : std::uint8_t {
  kNone = 0,       // it was
  kUntracked = 1,  // the system says so
  kInvalid = 2,    // not finite, or no unit quaternion
  kUntimely = 3,   // not newer than the last, older than the kept history, or ahead of the IMU
  kOutlier = 4,    // too far from the estimate
  kSwapped =
      5,  // turned against the estimate as no gyro misses it: markers taken for each other, another vehicle
  kFrozen = 6,  // the same again and again
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
  // Poses that disagreed for long were believed in the end, and the estimate jumped: how often, and by how
  // much in position and yaw the last time. A reference that is to stay where it is in the room jumps with
  // it.
  std::uint32_t resets = 0;
  Eigen::Vector3d reset_position_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d reset_rotation_ned = Eigen::Vector3d::Zero();  // rad, a rotation vector
};

class Estimator {
 public:
  explicit Estimator(const EstimatorSettings& settings);

  // Brings the estimate forward to the sample. Returns false, and changes nothing, for a sample that is not
  // finite or not newer than the last. A gap in the samples is bridged with the last rates and specific
  // force, and what may have happened in it is added to the covariance.
  bool predict(const plant::ImuSample& sample);

  // Takes a pose in. Returns false for one that is refused, and why is told in the estimate, of which nothing
  // else changes. A pose of the last stamp is the last that came again and leaves no trace.
  //
  // An innovation beyond the chi-square bound is cut to it if it is short of an outlier: a glitch moves the
  // estimate no faster than noise would, and does not make it surer. When the next ones contradict too, there
  // was a motion or a step that the noise densities leave out: variance of as much is added to position,
  // velocity and attitude, so that these follow the poses and the biases hardly do. Outliers are refused. In
  // flight they are believed in the end, and the estimate starts anew from them, where their stream has gone
  // on without a break since it agreed: then it is the IMU that misled, or was silent. A stream that has
  // stepped as no body moves is another one until it steps back. What only a motion explains that the IMU did
  // not see is believed when the IMU agrees with the poses' own motion since. With rotors off any stream is
  // believed that goes on for long.
  bool correct(const plant::PoseSample& pose, plant::RotorState rotors = plant::RotorState::kRunning);

  // A pose has been taken in, so the estimate has a meaning.
  bool initialised() const { return initialised_; }
  const Estimate& estimate() const { return now_; }
  // From the exposure of the last pose taken in to the estimate's stamp; infinite before the first.
  double pose_age_s() const;
  std::uint64_t pose_sequence() const { return pose_sequence_; }

  // Of the estimate's error at its stamp; infinite before the first pose. Takes some microseconds at most:
  // for telemetry.
  ErrorState standard_deviation() const { return covariance().standard_deviation(); }
  ErrorCovariance covariance() const;
  // Innovation of the last pose that was compared, squared and normalised: chi-square of 6 degrees of
  // freedom.
  double normalised_innovation() const { return normalised_innovation_; }

  static constexpr int kHistory = 256;  // IMU samples: 0.5 s at 500 Hz

 private:
  struct StateSnapshot {
    std::int64_t stamp_ns = 0;
    Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
    std::uint64_t corrections = 0;  // that it has seen, of all that were made
  };
  // A step of the error state at a moment, and what it makes of those before and after.
  struct Correction {
    StateSnapshot at;  // before the correction
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();          // that the rotation loses
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  // that the velocity loses
    void carry_to(StateSnapshot& moment) const;
  };

  // What is remembered is corrected when it is looked at: of most moments, nothing but the stamp ever is.
  static constexpr std::uint64_t kCorrections = 32;
  const StateSnapshot& history_at(std::uint64_t number) const { return history_[number % kHistory]; }
  StateSnapshot snapshot_at(std::uint64_t number) const;
  void start_at(const plant::PoseSample& pose);
  void show_path();
  void store_history();
  PoseFault fuse(const plant::PoseSample& pose, plant::RotorState rotors);
  PoseInnovation compare(const plant::PoseSample& pose);
  PoseFault disagree(const plant::PoseSample& pose, const PoseInnovation& innovation,
                     plant::RotorState rotors, bool believed);
  void accept(const plant::PoseSample& pose);  // from it on the stream is followed
  void agree(const PoseInnovation& innovation, const ErrorCovariance::Update& correction);
  ErrorCovariance::Update compute_update(const PoseInnovation& innovation) const;
  double outlier_rotation() const;  // rad
  bool believed_after_silence(const plant::PoseSample& pose, const PoseInnovation& innovation);
  void apply(const ErrorState& step);
  void replay();
  void restart_at(const plant::PoseSample& pose, const PoseInnovation& innovation);

  static ErrorInterval interval(const StateSnapshot& from, const StateSnapshot& to);
  // The covariance from one moment of the history to another; first is the number of the first after `from`.
  void advance(ErrorCovariance& covariance, StateSnapshot from, std::uint64_t first,
               const StateSnapshot& to) const;
  void advance_step(ErrorCovariance& covariance, const StateSnapshot& from, const StateSnapshot& to) const;
  // The nominal state at a stamp after the anchor's.
  StateSnapshot moment_at(std::int64_t stamp_ns, std::uint64_t first_newer) const;
  void anchor_at(const StateSnapshot& moment, std::uint64_t first_newer);

  EstimatorSettings settings_;
  DetectorSettings detectors_;  // of the settings
  ErrorNoise noise_;
  Estimate now_;
  StateSnapshot
      path_;  // what the IMU says, of the newest sample; before the first pose from an arbitrary start
  plant::ImuSample last_imu_;
  bool initialised_ = false;
  std::int64_t received_stamp_ns_ = 0;  // of the last pose that came
  std::int64_t pose_stamp_ns_ = 0;      // of the last that was taken in
  std::uint64_t pose_sequence_ = 0;
  double normalised_innovation_ = 0.0;
  StuckPoseDetector repetition_;
  PoseContinuity continuity_;
  bool unseen_ = false;             // the IMU was silent since the last pose that was taken in ...
  std::int64_t seen_again_ns_ = 0;  // ... until then
  PoseImuConsistencyTest trial_;
  int refused_in_a_row_ = 0;
  int contradictions_ = 0;  // in a row, of poses that were taken in

  // The covariance is that of the anchor: the last pose's moment, or one since.
  ErrorCovariance covariance_;
  StateSnapshot anchor_;
  std::uint64_t first_after_anchor_ = 0;  // number in the history

  std::array<StateSnapshot, kHistory> history_;
  std::uint64_t next_ = 0;  // number of the moment that will be remembered next
  std::array<Correction, kCorrections> corrections_;
  std::uint64_t corrections_made_ = 0;
};

}  // namespace swiftlet::control
