// Motion capture simulator. It is driven by the stamps of the ground truth only, so that it works the same in
// real time, scaled time and lockstep.
//
// Frames are exposed at the times of mocap_schedule.hpp, counted from stamp 0: multiples of the period or
// intervals drawn one by one. They are delivered one latency later. Both happen at the first truth stamp that
// is not earlier.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/simulation/mocap_schedule.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

class Mocap {
 public:
  Mocap(const MocapSettings& settings, std::uint64_t seed);

  // Processes the true pose at a stamp. Returns the oldest undelivered frame that is due, if any. If
  // exposures fall into a gap between truth samples, one frame is exposed at the end of the gap. A stamp that
  // is not newer than the last restarts the schedule: the plant has been restarted. Sequence numbers
  // continue.
  std::optional<PoseSample> update(std::int64_t stamp_ns, const Eigen::Vector3d& position_ned,
                                   const Eigen::Quaterniond& q_ned_from_frd);
  std::optional<PoseSample> update(const TruthSample& truth) {
    return update(truth.stamp_ns, truth.position_ned, truth.q_ned_from_frd);
  }

 private:
  PoseSample expose(std::int64_t stamp_ns, const Eigen::Vector3d& position_ned,
                    const Eigen::Quaterniond& q_ned_from_frd);
  Eigen::Vector3d error(
      math::RandomStream& noise) const;  // of unit bound (kBounded) or unit standard deviation
  bool in_dropout(std::int64_t stamp_ns);
  std::size_t wrapped(std::size_t i) const { return i < in_flight_.size() ? i : i - in_flight_.size(); }

  MocapSettings settings_;
  MocapSchedule schedule_;
  std::int64_t dropout_length_ns_;
  Eigen::Quaterniond misalignment_;
  math::RandomStream position_noise_;
  math::RandomStream orientation_noise_;
  math::RandomStream dropouts_;

  std::optional<std::int64_t> dropout_end_ns_;
  std::uint64_t sequence_ = 0;
  std::vector<PoseSample> in_flight_;  // ring buffer of exposed frames not yet delivered
  std::size_t oldest_ = 0;
  std::size_t count_ = 0;
};

}  // namespace swiftlet::plant
