#include "swiftlet/services/rtps/moved_hosts.hpp"

#include <algorithm>

namespace swiftlet::rtps {

void MovedHosts::heard(const Announced& said, Ipv4 source, std::int64_t now_ns) {
  const auto contains = [](const auto& list, Ipv4 address) {
    return std::find(list.begin(), list.end(), address) != list.end();
  };
  const bool is_there = contains(said.addresses, source);
  for (const Ipv4 address : said.addresses) {
    Host& host = this->host(address);
    const Ipv4 wanted = is_there ? address : source;
    if (host.used != wanted) {
      if (!is_there && now_ns - host.heard_ns < kSilence_ns) continue;
      if (io::is_loopback(source) && contains(own_, address)) continue;
      use(host, wanted);
    }
    host.heard_ns = now_ns;
  }
}

MovedHosts::Host& MovedHosts::host(Ipv4 announced) {
  const auto known = std::find_if(hosts_.begin(), hosts_.end(),
                                  [announced](const Host& it) { return it.announced == announced; });
  if (known != hosts_.end()) return *known;
  const Host unmoved{announced, announced, -kSilence_ns};
  if (hosts_.size() < hosts_.capacity()) {
    hosts_.push_back(unmoved);
    return hosts_.back();
  }
  Host& silent = *std::min_element(hosts_.begin(), hosts_.end(),
                                   [](const Host& a, const Host& b) { return a.heard_ns < b.heard_ns; });
  if (silent.announced != silent.used) --moved_;
  return silent = unmoved;
}

void MovedHosts::use(Host& host, Ipv4 address) {
  moved_ += static_cast<int>(address != host.announced) - static_cast<int>(host.used != host.announced);
  host.used = address;
  if (!io::is_loopback(address) && news_.size() < kMostNews) news_.push_back({host.announced, address});
}

Ipv4 MovedHosts::now_at(Ipv4 announced) const {
  for (const Host& host : hosts_) {
    if (host.announced == announced) return host.used;
  }
  return announced;
}

}  // namespace swiftlet::rtps
