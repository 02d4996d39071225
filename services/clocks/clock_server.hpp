// The clock of a vehicle, for processes with a clock of their own.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::clocks {

// Answers clock_request with the times at which it arrived and was answered.
class ClockServer {
 public:
  // now_ns: the vehicle's clock, as in the stamps of the vehicle; nullopt while it does not run. Called in the thread that
  // receives.
  ClockServer(dds::Node& node, std::function<std::optional<std::int64_t>()> now_ns);

 private:
  void answer(const messages::msg::ClockRequest& request);

  std::function<std::optional<std::int64_t>()> now_ns_;
  dds::Publisher<messages::msg::ClockReply> replies_;
  dds::Subscription requests_;  // last: its callback uses all members above
};

}  // namespace swiftlet::clocks
