// Motion capture, driven by truth stamps alone: it works the same in real time, scaled time and lockstep.
//
// Frames are exposed at times that the model gives, counted from stamp 0, and delivered a latency later:
// whole multiples of the period, or intervals drawn one by one (mocap_schedule.hpp). When truth comes in
// steps, both happen at the first truth stamp that is not earlier.
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

  // Takes in what is true at a stamp; hands back the oldest frame that is due and has not been handed out.
  // Frames that fall into a gap between truth samples are exposed, once, at its end. A stamp that is not
  // newer than the last starts the schedule anew: the plant has been restarted; sequences go on.
  std::optional<PoseSample> update(std::int64_t stamp_ns, const Eigen::Vector3d& position_ned,
                                   const Eigen::Quaterniond& q_ned_from_frd);
  std::optional<PoseSample> update(const TruthSample& truth) {
    return update(truth.stamp_ns, truth.position_ned, truth.q_ned_from_frd);
  }

 private:
  PoseSample expose(std::int64_t stamp_ns, const Eigen::Vector3d& position_ned,
                    const Eigen::Quaterniond& q_ned_from_frd);
  Eigen::Vector3d error(RandomStream& noise) const;  // of size 1
  bool in_dropout(std::int64_t stamp_ns);

  MocapSettings settings_;
  MocapSchedule schedule_;
  std::int64_t dropout_length_ns_;
  Eigen::Quaterniond misalignment_;
  RandomStream position_noise_;
  RandomStream orientation_noise_;
  RandomStream dropouts_;

  std::optional<std::int64_t> dropout_end_ns_;
  std::uint64_t sequence_ = 0;
  std::vector<PoseSample> in_flight_;  // ring
  std::size_t oldest_ = 0;
  std::size_t count_ = 0;
};

}  // namespace swiftlet::plant
