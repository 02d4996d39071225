// What one viewer has asked for, and what is on its way to it. The connection is that of view_server.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/ground/view/foxglove.hpp"
#include "swiftlet/ground/view/frame_queue.hpp"
#include "swiftlet/ground/view/live_topics.hpp"
#include "swiftlet/record/mcap/records.hpp"

namespace swiftlet::ground {

// A message to a viewer: the head, then the payload if there is one.
struct Outgoing {
  bool is_text = false;
  mcap::Bytes head;
  std::shared_ptr<const mcap::Bytes> payload;
};

// Not thread-safe.
class Viewer {
 public:
  static constexpr std::size_t kMostQueuedBytes = std::size_t{1} << 20U;  // of messages of topics
  static constexpr std::size_t kMostReplies = 500;                        // that wait
  static constexpr std::size_t kMostRefusals = 10;                        // of one message, that are told

  // topics must outlive it.
  Viewer(LiveTopics& topics, Selection selection) : topics_(topics), queue_(kMostQueuedBytes, selection) {}
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  // Subscribes or unsubscribes. What is wrong with it is a status message to the viewer.
  void take(const foxglove::Subscribe& message);
  void take(const foxglove::Unsubscribe& message);

  // Before everything else that waits.
  void reply(const std::string& text);
  void reply(mcap::Bytes binary);

  // A message of a channel, if the viewer has subscribed to it.
  void put(std::uint32_t channel, const LiveTopics::Live& live);
  void begin_round() { queue_.begin_round(); }

  std::optional<Outgoing> next();
  // It does not read the replies to what it sends: to be disconnected.
  bool is_stuck() const { return replies_.size() > kMostReplies; }
  std::uint64_t dropped() const { return queue_.dropped(); }  // because it is slow

 private:
  class Refusals;

  LiveTopics& topics_;
  std::map<std::uint32_t, std::uint32_t> channels_;       // by subscription
  std::map<std::uint32_t, std::uint32_t> subscriptions_;  // by channel
  std::deque<Outgoing> replies_;
  FrameQueue queue_;
};

}  // namespace swiftlet::ground
