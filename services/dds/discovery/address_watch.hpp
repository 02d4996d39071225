// Notices that the addresses of this host have changed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::dds {

// Not thread-safe.
class AddressWatch {
 public:
  // interfaces: of this host now. A sentence, with what follows from it for a process with these settings, if their addresses have
  // changed since the last call; at the first call, if there are none but those of the loopback interface.
  std::optional<std::string> change(const std::vector<io::Interface>& interfaces,
                                    const NetworkSettings& network);

 private:
  std::optional<std::string> addresses_;  // "10.0.0.1 of eth0, ..."
};

}  // namespace swiftlet::dds
