// The way of a frame from motion capture to whoever listens, with the faults that befall it there.
//
// In lockstep the plant sends the numbers of the frames that it expects down a path of its own: so it knows
// which of them come out, and when.
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
  // The seed is that of Mocap.
  MocapPath(const SimulationSettings& settings, std::uint64_t seed);

  // What comes out at a stamp, at which motion capture hands over `frame`, or nothing. Stamps that go back
  // start it anew: the plant has been restarted.
  std::optional<PoseSample> pass(const std::optional<PoseSample>& frame, std::int64_t now_ns);

 private:
  void disturb(PoseSample& frame, std::int64_t now_ns);

  FaultSchedule faults_;
  bool faultless_;
  double other_body_error_m_;
  RandomStream other_body_noise_;
  DelayLine<PoseSample> delayed_;
  std::optional<PoseSample> last_tracked_;  // that came out before the freeze
  std::int64_t last_ns_ = 0;
};

}  // namespace swiftlet::plant
