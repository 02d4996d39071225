// How often each datagram of discovery is sent. Discovery waits a second for a lost one that tells of endpoints, because Fast DDS
// has no setting for the heartbeats of its own endpoints; and a process from which another one hears nothing else is taken for
// dead after four lost announcements. Receivers ignore the copies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "swiftlet/services/dds/discovery/announcement_budget.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/rtps/datagram_guard.hpp"

namespace swiftlet::dds {

// True for the UDP ports to which the processes of this domain send discovery.
bool is_discovery_port(int domain, std::uint32_t port);

// A digest of what an RTPS message says, without its time, if participants only announce themselves in it, or assert that they
// live. nullopt: another message.
std::optional<std::uint64_t> announcement_digest(const std::uint8_t* message, std::size_t size);

// The repetition of discovery on one channel. Not thread-safe.
class RepeatedDiscovery {
 public:
  using Places = std::vector<fastrtps::Locator_t>;

  // The places that get the first copy of a datagram, those that get a second one, and so on, as AnnouncementBudget has it
  // for the processes that `guard` has heard. places: to which the datagram is sent. No announcement is sent before the guard
  // listens: Fast DDS begins to announce a participant before it takes in what the others answer.
  std::vector<Places> rounds(const std::vector<std::uint8_t>& datagram, const Places& places,
                             rtps::DatagramGuard& guard);

 private:
  std::map<fastrtps::Locator_t, AnnouncementBudget> budgets_;
};

}  // namespace swiftlet::dds
