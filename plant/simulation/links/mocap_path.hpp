// Link of the frames from motion capture to the subscribers, with the injected faults.
//
// In lockstep the plant passes the sequence numbers of the frames that it expects through its own copy of
// this link. It then knows which of them are delivered, and when.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/simulation/links/delay_line.hpp"
#include "swiftlet/plant/simulation/links/faults.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

class MocapPath {
 public:
  // seed: the same as for Mocap.
  MocapPath(const SimulationSettings& settings, std::uint64_t seed);

  // Returns the frame delivered at now_ns, if any. `frame` is the frame that motion capture outputs at this
  // stamp, or nullopt. A stamp earlier than the last resets the link: the plant has been restarted.
  std::optional<PoseSample> pass(const std::optional<PoseSample>& frame, std::int64_t now_ns);

 private:
  void disturb(PoseSample& frame, std::int64_t now_ns);

  FaultSchedule faults_;
  bool faultless_;
  double other_body_error_m_;
  math::RandomStream other_body_noise_;
  DelayLine<PoseSample> delayed_;
  std::optional<PoseSample> last_tracked_;  // repeated by kMocapFreeze
  std::int64_t last_ns_ = 0;
};

}  // namespace swiftlet::plant
