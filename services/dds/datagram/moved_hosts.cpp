#include "swiftlet/services/dds/datagram/moved_hosts.hpp"

#include <algorithm>

namespace swiftlet::comms {
namespace {

constexpr std::uint64_t pair(Ipv4 announced, Ipv4 used) { return std::uint64_t{announced} << 32U | used; }
constexpr Ipv4 announced_of(std::uint64_t pair) { return static_cast<Ipv4>(pair >> 32U); }
constexpr Ipv4 used_of(std::uint64_t pair) { return static_cast<Ipv4>(pair); }

}  // namespace

void MovedHosts::heard(const Announced& said, Ipv4 source, std::int64_t now_ns) {
  const bool is_there =
      std::find(said.addresses.begin(), said.addresses.end(), source) != said.addresses.end();
  for (const Ipv4 address : said.addresses) {
    Host& host = this->host(address);
    const Ipv4 wanted = is_there ? address : source;
    if (used_of(host.addresses) != wanted) {
      if (!is_there && now_ns - host.heard_ns < kSilence_ns) continue;
      if (is_loopback(source) && std::find(own_.begin(), own_.end(), address) != own_.end()) continue;
      use(host, address, wanted);
    }
    host.heard_ns = now_ns;
  }
}

MovedHosts::Host& MovedHosts::host(Ipv4 announced) {
  auto* const known = std::find_if(hosts_.begin(), hosts_.end(), [announced](const Host& it) {
    return announced_of(it.addresses) == announced;
  });
  if (known != hosts_.end()) return *known;
  // Places that were never used have been silent longest.
  Host& free = *std::min_element(hosts_.begin(), hosts_.end(),
                                 [](const Host& a, const Host& b) { return a.heard_ns < b.heard_ns; });
  if (announced_of(free.addresses) != used_of(free.addresses)) --moved_;
  free.addresses = pair(announced, announced);
  free.heard_ns = -kSilence_ns;
  return free;
}

void MovedHosts::use(Host& host, Ipv4 announced, Ipv4 address) {
  const bool had_moved = used_of(host.addresses) != announced;
  host.addresses = pair(announced, address);
  moved_ += static_cast<int>(address != announced) - static_cast<int>(had_moved);
  if (!is_loopback(address) && news_.size() < kMostNews) news_.push_back({announced, address});
}

Ipv4 MovedHosts::now_at(Ipv4 announced) const {
  for (const Host& host : hosts_) {
    const std::uint64_t addresses = host.addresses.load(std::memory_order_relaxed);
    if (announced_of(addresses) == announced) return used_of(addresses);
  }
  return announced;
}

}  // namespace swiftlet::comms
