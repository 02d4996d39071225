// The topics of running vehicles as channels: those that the vehicles publish, and the standard messages that follow
// from them, as in a recorded flight.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/view/foxglove.hpp"
#include "swiftlet/record/file/standard_messages.hpp"
#include "swiftlet/record/recorder/sample_queue.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Only what somebody uses is received, and the logs from the start. The threads that receive copy into a bounded queue and
// do not wait. All functions from one thread.
class LiveTopics {
 public:
  explicit LiveTopics(const Context& context);
  ~LiveTopics();
  LiveTopics(const LiveTopics&) = delete;
  LiveTopics& operator=(const LiveTopics&) = delete;

  // Adds the channels of a vehicle. Throws std::runtime_error; called again, it adds what is missing.
  void add_vehicle(const std::string& name);
  // With ids from 0 in this order.
  const std::vector<foxglove::Channel>& channels() const { return channels_; }

  struct Live {
    std::int64_t time_ns = 0;  // arrival, since 1970
    std::shared_ptr<const mcap::Bytes> payload;
    bool is_event = false;  // a request, an answer or a line of a log: a newer one does not replace it
  };
  // Counts the users of a channel. Returns what a new one gets first: the newest message, or of a log the last lines. Throws
  // std::runtime_error if the topic cannot be received.
  std::vector<Live> use(std::uint32_t channel);
  void release(std::uint32_t channel);

  // Calls take(channel, message) for what came since the last call, of the channels in use.
  void take_all(const std::function<void(std::uint32_t, const Live&)>& take);

  // Messages that were received while the queue was full.
  std::uint64_t dropped() const;

 private:
  struct Vehicle;
  struct Source;
  struct State {
    std::vector<Source*> sources;
    std::size_t users = 0;
    std::deque<Live> last;  // oldest first
    bool is_event = false;
    std::size_t kept = 1;  // of them
  };

  std::uint32_t add_channel(const std::string& topic, const messages::MessageSchema& schema);
  void add_topics(Vehicle& vehicle);
  template <class T>
  void add_topic(Vehicle& vehicle, const messages::Topic<T>& topic);

  const dds::Participant participant_;
  record::SampleQueue queue_;
  std::vector<foxglove::Channel> channels_;
  std::vector<State> states_;                   // of the channels
  std::map<std::string, std::uint32_t> known_;  // channels by topic
  std::deque<Vehicle> vehicles_;
  std::deque<Source> sources_;  // last: their callbacks use the queue
};

}  // namespace swiftlet::ground
