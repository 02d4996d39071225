#include "swiftlet/services/dds/discovery/address_watch.hpp"

#include <utility>

namespace swiftlet::comms {
namespace {

constexpr const char* kNone = "this host has no IPv4 address but that of the loopback interface";

std::string listed(const std::set<std::string>& addresses) {
  std::string list;
  for (const std::string& address : addresses) list += (list.empty() ? "" : ", ") + address;
  return list;
}

}  // namespace

std::optional<std::string> AddressWatch::poll(const std::vector<runtime::Interface>& interfaces,
                                              const NetworkSettings& network) {
  std::set<std::string> now;
  for (const runtime::Interface& it : interfaces) {
    if (!it.is_loopback) now.insert(it.address + " of " + it.name);
  }
  return change(std::move(now), network);
}

std::optional<std::string> AddressWatch::change(std::set<std::string> now, const NetworkSettings& network) {
  if (addresses_ == now) return std::nullopt;
  const bool is_first = !addresses_;
  addresses_ = std::move(now);
  const bool is_alone = addresses_->empty();
  if (is_first)
    return is_alone
               ? std::optional(kNone + std::string(": others reach it when it has one; IPv6 is not used"))
               : std::nullopt;
  const std::string what = is_alone ? kNone + std::string(" now")
                                    : "the addresses of this host are " + listed(*addresses_) + " now";
  if (!network.interfaces.empty())
    return what + "; --interface keeps to those of the start: restart this process if they have gone";
  if (!network.discovery_servers.empty())
    return what + "; the discovery server names those of the start: restart this process if they have gone";
  return what + (is_alone ? ": others reach it when it has one" : ", and announced");
}

}  // namespace swiftlet::comms
