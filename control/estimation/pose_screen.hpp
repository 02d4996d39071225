// What can be wrong with a stream of poses that one pose alone does not show: frozen markers, and a jump that
// stays.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "control/estimation/error_covariance.hpp"
#include "plant/model/samples.hpp"

namespace swiftlet::control {

// Recognises a stream that says the same again and again. A vehicle that moves while its pose does not gives
// it away, once the innovation contradicts. In hover nothing contradicts, but noise does not repeat: a stream
// that never did while the vehicle stood with its rotors off is frozen when it does. A stream without noise
// repeats from the start and is not judged by that.
class RepetitionWatch {
 public:
  void look_at(const plant::PoseSample& pose, plant::RotorState rotors);

  // The newest pose is the one before it.
  bool repeats() const { return repetitions_ > 0; }
  // It has been the same for so long as noise never is.
  bool frozen() const { return noisy_ && repetitions_ >= kRepetitions; }

  static constexpr int kRepetitions = 5;  // a single one happens: a frame that is sent twice

 private:
  plant::PoseSample last_;
  int repetitions_ = 0;
  int distinct_ = 0;  // in a row, with the rotors off
  bool noisy_ = false;
};

// Whether a stream goes on without a break, as the pose of a body does that moves: not after a jump, nor
// after a gap in which a jump would not be seen.
class Continuity {
 public:
  void look_at(const plant::PoseSample& pose);
  // The newest pose agrees with the estimate: from here on.
  void begin() {
    unbroken_ = true;
    in_reach_ = true;
  }
  void end() { unbroken_ = false; }

  // A body could have gone the way from pose to pose since begin(), also where some are missing.
  bool in_reach() const { return in_reach_; }
  // Since begin().
  bool unbroken() const { return unbroken_; }
  double interval_s() const { return interval_s_; }  // between the newest two
  // Between the newest pose and that of kSpan poses before, m/s.
  Eigen::Vector3d velocity_ned() const;

 private:
  static constexpr std::size_t kSpan = 4;

  const plant::PoseSample& before(std::uint64_t count) const {
    return last_[(next_ - 1 - count) % last_.size()];
  }

  bool unbroken_ = false;
  bool in_reach_ = false;
  double interval_s_ = 0.0;
  std::array<plant::PoseSample, kSpan + 1> last_;
  std::uint64_t next_ = 0;  // of all that came
};

// Poses that disagree with the estimate, one after the other. When they agree with each other for long, it is
// the world that has jumped, or the estimate that is wrong.
class Disagreement {
 public:
  // The innovation of a pose that was refused for it. The disagreement may wander by max_drift, in m/s, and
  // still be the same.
  void add(std::int64_t stamp_ns, const PoseInnovation& innovation, double max_drift);
  void clear() { count_ = 0; }

  bool persistent() const { return count_ >= kPoses && stamp_ns_ - first_stamp_ns_ >= kTime_ns; }

  static constexpr int kPoses = 8;
  static constexpr std::int64_t kTime_ns = 200'000'000;

 private:
  int count_ = 0;
  std::int64_t first_stamp_ns_ = 0;
  std::int64_t stamp_ns_ = 0;
  PoseInnovation first_;
};

}  // namespace swiftlet::control
