// When motion capture exposes frames and hands them out. A function of settings, seed and the stamps at which
// it is asked: whoever has these, as the plant in lockstep, knows it as well as the cameras do.
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
    bool starts_anew = false;  // frames that were under way are lost
    bool exposes = false;      // a frame, now
    bool delivers = false;     // the oldest frame that is under way
  };
  // What happens at this stamp, after the one before. Frames that fall between two stamps are exposed, once,
  // at the second. A stamp that is not newer than the last starts the schedule anew.
  Events advance(std::int64_t stamp_ns);

  // That advance() has let out; those of schedules begun before count.
  std::uint64_t delivered() const { return delivered_; }
  // Frames that can be under way.
  std::size_t capacity() const { return in_flight_.size(); }

 private:
  void start(std::int64_t stamp_ns);
  std::int64_t interval_ns();

  MocapSettings settings_;
  std::uint64_t seed_;
  std::int64_t latency_ns_;
  RandomStream intervals_;
  std::optional<std::int64_t> last_stamp_ns_;
  std::int64_t next_exposure_ns_ = 0;
  std::uint64_t delivered_ = 0;
  std::vector<std::int64_t> in_flight_;  // ring of exposure stamps
  std::size_t oldest_ = 0;
  std::size_t count_ = 0;
};

}  // namespace swiftlet::plant
