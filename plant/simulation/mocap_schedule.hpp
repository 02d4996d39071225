// Schedule of motion capture: when frames are exposed and delivered. It is a function of the settings, the
// seed and the stamps of the calls only. In lockstep the plant can therefore compute it as well as the motion
// capture simulator.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/simulation/settings.hpp"

namespace swiftlet::plant {

class MocapSchedule {
 public:
  MocapSchedule(const MocapSettings& settings, std::uint64_t seed);

  struct Events {
    bool restarts = false;  // the schedule restarts; frames in flight are lost
    bool exposes = false;   // a frame is exposed
    bool delivers = false;  // the oldest frame in flight is delivered
  };
  // Returns what happens at this stamp. If exposures fall between the last stamp and this one, one frame is
  // exposed at this one. A stamp that is not newer than the last restarts the schedule.
  Events advance(std::int64_t stamp_ns);

  // Number of frames delivered since construction, across restarts of the schedule.
  std::uint64_t delivered() const { return delivered_; }
  // Largest number of frames in flight.
  std::size_t capacity() const { return in_flight_.size(); }

 private:
  void start(std::int64_t stamp_ns);
  std::int64_t interval_ns();
  std::size_t wrapped(std::size_t i) const { return i < in_flight_.size() ? i : i - in_flight_.size(); }

  MocapSettings settings_;
  std::uint64_t seed_;
  std::int64_t latency_ns_;
  math::RandomStream intervals_;
  std::optional<std::int64_t> last_stamp_ns_;
  std::int64_t next_exposure_ns_ = 0;
  std::uint64_t delivered_ = 0;
  std::vector<std::int64_t> in_flight_;  // ring buffer of exposure stamps
  std::size_t oldest_ = 0;
  std::size_t count_ = 0;
};

}  // namespace swiftlet::plant
