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

// When the changes of participants are due. Not thread-safe.
class ChangeSpacing {
 public:
  using Time = std::chrono::steady_clock::time_point;
  // Returns the time from which on the change may be handed on, and takes it as handed on then. `now` if the last change of
  // the participant is longer than kChangeSpacing ago, and for repetitions of it.
  Time due(const ParticipantChange& change, Time now);

 private:
  struct Last {
    std::int64_t sequence_number;
    Time time;
  };
  std::map<GuidPrefix, Last> last_;  // younger than kChangeSpacing
};

// Descriptor of the transport below, of which the thread that receives waits until a change is due. Drops what it receives
// until `open` is true.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> space_changes(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> below,
    std::shared_ptr<const std::atomic<bool>> open);

}  // namespace swiftlet::comms
