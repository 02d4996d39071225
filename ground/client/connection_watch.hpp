// Whether a vehicle's control process is heard, and whether it is the one that was.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/client/connection.hpp"

namespace swiftlet::ground {

bool is_connected(const View& view, Clock::time_point now);

class ConnectionWatch {
 public:
  // What has changed since the last look.
  std::optional<ConnectionEvent> look(const View& view, Clock::time_point now);

 private:
  bool connected_ = false;
  std::uint64_t controller_ = 0;  // that was heard last; 0: none yet
};

}  // namespace swiftlet::ground
