#include "swiftlet/services/dds/discovery/interfaces.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <memory>
#include <net/if.h>
#include <netinet/in.h>

namespace swiftlet::comms {

std::string interfaces_text(bool localhost_only) {
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return "unknown interfaces";
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(first, ::freeifaddrs);
  std::string text;
  for (const ifaddrs* it = first; it != nullptr; it = it->ifa_next) {
    if (it->ifa_addr == nullptr || it->ifa_addr->sa_family != AF_INET) continue;
    if ((it->ifa_flags & IFF_UP) == 0U) continue;
    if (localhost_only && (it->ifa_flags & IFF_LOOPBACK) == 0U) continue;
    char address[INET_ADDRSTRLEN] = {};
    ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(it->ifa_addr)->sin_addr, address,
                sizeof address);
    text += (text.empty() ? "" : ", ") + std::string(it->ifa_name) + " (" + address + ")";
  }
  return text.empty() ? "no interface that is up" : text;
}

}  // namespace swiftlet::comms
