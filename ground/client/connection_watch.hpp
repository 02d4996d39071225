// Detects changes of the connection to a vehicle's control process.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/client/connection.hpp"

namespace swiftlet::ground {

bool is_connected(const View& view, Clock::time_point now);

class ConnectionWatch {
 public:
  // The change since the last call; nullopt if there is none.
  std::optional<ConnectionEvent> update(const View& view, Clock::time_point now);

 private:
  bool connected_ = false;
  std::uint64_t controller_ = 0;  // heard last; 0: none yet
};

}  // namespace swiftlet::ground
