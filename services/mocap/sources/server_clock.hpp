// Relates the clock of a server to that of this host.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/services/clocks/clock_filter.hpp"

namespace swiftlet::mocap {

class ServerClock {
 public:
  // A question of this host and its answer: when it was asked and the answer arrived, host's clock, and the time of the server
  // when it answered.
  void add(std::int64_t asked_ns, std::int64_t server_ns, std::int64_t arrived_ns);
  // The host's time of a stamp of the server in what arrived at arrived_ns, host's clock. nullopt: not enough exchanges, or one
  // of the clocks may have been set: as the exchanges show, or because the stamp would be after the arrival or long before.
  std::optional<std::int64_t> to_host(std::int64_t server_ns, std::int64_t arrived_ns) const;
  bool is_known() const;
  void forget() { filter_ = {}; }

 private:
  clocks::ClockFilter filter_;
};

}  // namespace swiftlet::mocap
