#include "swiftlet/services/dds/discovery/address_watch.hpp"

#include <algorithm>
#include <utility>

#include "swiftlet/io/text.hpp"

namespace swiftlet::dds {

std::optional<std::string> AddressWatch::change(const std::vector<io::Interface>& interfaces,
                                                const NetworkSettings& network) {
  const std::string none = "this host has no IPv4 address but that of the loopback interface";
  std::vector<std::string> found;
  for (const io::Interface& it : interfaces) {
    if (!it.is_loopback) found.push_back(it.address + " of " + it.name);
  }
  std::sort(found.begin(), found.end());
  const std::string now = io::joined(found, ", ");
  const std::optional<std::string> before = std::exchange(addresses_, now);
  if (before == now) return std::nullopt;
  if (!before && !now.empty()) return std::nullopt;
  if (!before) return none + ": others reach it when it has one; IPv6 is not used";
  const std::string what = now.empty() ? none + " now" : "the addresses of this host are " + now + " now";
  if (!network.interfaces.empty())
    return what + "; --interface keeps to those of the start: restart this process if they have gone";
  if (!network.discovery_servers.empty())
    return what + "; the discovery server names those of the start: restart this process if they have gone";
  return what + (now.empty() ? ": others reach it when it has one" : ", and announced");
}

}  // namespace swiftlet::dds
