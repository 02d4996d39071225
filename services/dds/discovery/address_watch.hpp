// Notices that the addresses of this host have changed.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// Not thread-safe.
class AddressWatch {
 public:
  // A sentence, with what follows from it for a process with these settings, if the addresses of this host have changed since the
  // last call; at the first call, if there are none but those of the loopback interface.
  std::optional<std::string> poll(const std::vector<runtime::Interface>& interfaces,
                                  const NetworkSettings& network);
  // The same of given addresses, "10.0.0.1 of eth0".
  std::optional<std::string> change(std::set<std::string> now, const NetworkSettings& network);

 private:
  std::optional<std::set<std::string>> addresses_;  // but for the loopback interface
};

}  // namespace swiftlet::comms
