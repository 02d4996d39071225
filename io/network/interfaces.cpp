#include "swiftlet/io/network/interfaces.hpp"

#include <algorithm>
#include <cstring>
#include <ifaddrs.h>
#include <memory>
#include <net/if.h>
#include <netinet/in.h>
#include <stdexcept>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include "swiftlet/io/descriptor.hpp"

namespace swiftlet::io {
namespace {

int mtu_of(const char* interface) {
  const Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq request{};
  std::strncpy(request.ifr_name, interface, IFNAMSIZ - 1);
  return ::ioctl(socket.get(), SIOCGIFMTU, &request) == 0 ? request.ifr_mtu : 0;
}

}  // namespace

std::vector<Interface> interfaces_up() {
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(first, ::freeifaddrs);
  std::vector<Interface> found;
  for (const ifaddrs* it = first; it != nullptr; it = it->ifa_next) {
    if (it->ifa_addr == nullptr || it->ifa_addr->sa_family != AF_INET) continue;
    if ((it->ifa_flags & IFF_UP) == 0U || (it->ifa_flags & IFF_RUNNING) == 0U) continue;
    const Ipv4 address = ntohl(reinterpret_cast<const sockaddr_in*>(it->ifa_addr)->sin_addr.s_addr);
    found.push_back({it->ifa_name, to_string(address), (it->ifa_flags & IFF_LOOPBACK) != 0U,
                     (it->ifa_flags & IFF_MULTICAST) != 0U, mtu_of(it->ifa_name), address});
  }
  return found;
}

bool is_own_address(const std::string& ipv4) {
  const std::vector<Interface> own = interfaces_up();
  return std::any_of(own.begin(), own.end(), [&](const Interface& it) { return it.address == ipv4; });
}

std::string interfaces_text(bool localhost_only) {
  std::string text;
  for (const Interface& it : interfaces_up()) {
    if (localhost_only && !it.is_loopback) continue;
    text += (text.empty() ? "" : ", ") + it.name + " (" + it.address + ")";
  }
  return text.empty() ? "no interface that is up" : text;
}

std::string fault_of_interface(const std::string& name_or_address) {
  for (const Interface& it : interfaces_up()) {
    if (it.name == name_or_address || it.address == name_or_address) return "";
  }
  return "is '" + name_or_address +
         "', must be an interface that is up, by name or IPv4 address: " + interfaces_text(false);
}

std::vector<std::string> addresses_of_interfaces(const std::vector<std::string>& names_or_addresses) {
  std::vector<std::string> addresses;
  for (const std::string& wanted : names_or_addresses) {
    if (const std::string fault = fault_of_interface(wanted); !fault.empty())
      throw std::runtime_error("interface " + fault);
    for (const Interface& it : interfaces_up()) {
      if (it.name == wanted || it.address == wanted) addresses.push_back(it.address);
    }
  }
  return addresses;
}

}  // namespace swiftlet::io
