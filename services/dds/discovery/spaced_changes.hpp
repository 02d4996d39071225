// A transport of Fast DDS for a discovery server, which hands on the announcements of a participant with a time between
// them. The server of Fast DDS, up to 3.6 at least, frees an announcement of which it takes the next one before it has sent
// it on, then sends it all the same, and fails the assertion "min_seq <= last_seq" when the memory is used again
// (DiscoveryDataBase::update_participant_from_change_ leaves it in pdp_to_send_).
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "swiftlet/services/dds/datagram/rtps_ids.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::comms {

// The server takes in an announcement at once; this is for a host without enough CPU time.
constexpr std::chrono::milliseconds kChangeSpacing{100};

struct ParticipantChange {
  GuidPrefix participant{};
  std::int64_t sequence_number = 0;
};
// Of a message of RTPS: the last announcement or goodbye of a participant in it. nullopt if there is none.
std::optional<ParticipantChange> participant_change(const std::uint8_t* message, std::size_t size);

// Divides a message of RTPS with several of them into messages with one each: nothing keeps two in one message apart.
std::vector<std::vector<std::uint8_t>> divide_changes(const std::uint8_t* message, std::size_t size);

// Which changes may be handed on. Remembers at most kMostParticipants. Not thread-safe.
class ChangeSpacing {
 public:
  using Time = std::chrono::steady_clock::time_point;
  // Returns whether the change may be handed on now, and takes it as handed on if so: repetitions of the last change of the
  // participant, and the first one that comes kChangeSpacing after it.
  bool admit(const ParticipantChange& change, Time now);

 private:
  struct Last {
    std::int64_t sequence_number;
    Time time;
  };
  std::map<GuidPrefix, Last> last_;  // younger than kChangeSpacing
};

// Changes that came too early. Not thread-safe.
class EarlyChanges {
 public:
  // Each is a datagram of 64 KiB at most.
  static constexpr std::size_t kMost = 64;
  static constexpr std::size_t kMostOfParticipant = 4;
  struct Datagram {
    ParticipantChange change;
    std::vector<std::uint8_t> bytes;
    const void* receiver = nullptr;  // for which it came
    rtps::Locator_t sender;
  };
  // Drops it if there are too many: clients repeat an announcement until the server acknowledges it, and the lease of a
  // participant ends whose goodbye is lost.
  void keep(Datagram datagram);
  // Takes one that `spacing` admits now, in the order of their participant: a reliable reader waits for the one that is
  // missing. nullopt if there is none.
  std::optional<Datagram> take(const void* receiver, ChangeSpacing& spacing, ChangeSpacing::Time now);

 private:
  std::map<std::pair<GuidPrefix, std::int64_t>, Datagram> kept_;  // by participant and sequence number
};

// Descriptor of a transport in front of the one below. It never waits: a change that comes too early is handed on before the
// first datagram after it is due. Drops what it receives until `open` is true.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> space_changes(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> below,
    std::shared_ptr<const std::atomic<bool>> open);

}  // namespace swiftlet::comms
