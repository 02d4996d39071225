// Motion capture, driven by truth stamps alone: it works the same in real time, scaled time and lockstep.
//
// Frames are exposed at whole multiples of the period, counted from stamp 0, and delivered a latency later.
// When truth comes in steps, both happen at the first truth stamp that is not earlier.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "plant/model/samples.hpp"
#include "plant/simulation/random.hpp"
#include "plant/simulation/settings.hpp"

namespace swiftlet::plant {

class Mocap {
 public:
  Mocap(const MocapSettings& settings, std::uint64_t seed);

  // Takes in what is true at a stamp; hands back the oldest frame that is due and has not been handed out.
  // Frames that fall into a gap between truth samples are exposed, once, at its end. A stamp that is not
  // newer than the last starts the schedule anew: the plant has been restarted; sequences go on.
  std::optional<PoseSample> update(const TruthSample& truth);

 private:
  PoseSample expose(const TruthSample& truth);
  bool in_dropout(std::int64_t stamp_ns);

  MocapSettings settings_;
  std::int64_t period_ns_;
  std::int64_t latency_ns_;
  std::int64_t dropout_length_ns_;
  Eigen::Quaterniond misalignment_;
  RandomStream position_noise_;
  RandomStream orientation_noise_;
  RandomStream dropouts_;

  std::optional<std::int64_t> last_stamp_ns_;
  std::int64_t last_frame_ = 0;  // period number
  std::optional<std::int64_t> dropout_end_ns_;
  std::uint64_t sequence_ = 0;
  std::vector<PoseSample> in_flight_;  // ring
  std::size_t oldest_ = 0;
  std::size_t count_ = 0;
};

// Sequence of the newest frame that update() has handed out when it has seen truth at stamps 0,
// truth_period_ns, ..., stamp_ns; 0 before the first. In lockstep the plant waits for it.
std::uint64_t newest_mocap_sequence(const MocapSettings& settings, std::int64_t truth_period_ns,
                                    std::int64_t stamp_ns);

// Whether update() exposes or hands out a frame at this stamp, of those 0, truth_period_ns, ...: in lockstep
// the others need not be sent.
bool mocap_needs_truth(const MocapSettings& settings, std::int64_t truth_period_ns, std::int64_t stamp_ns);

}  // namespace swiftlet::plant
