// The messages of one topic of a vehicle as they arrive, decoded into numbers and texts as those of a recorded flight.
//
//   TopicStream stream(context.participant(), "kl1", "estimate");
//   while (const auto sample = stream.next(std::chrono::seconds(1))) use(stream.columns(), sample->values);
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/record/mcap/message_decoder.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Thread-safe.
class TopicStream {
 public:
  struct Sample {
    std::int64_t received_ns = 0;     // ns since 1970, when it arrived
    std::vector<mcap::Value> values;  // one for each of columns()
  };

  // topic: "estimate". capacity: samples that wait for next(); of more than that the oldest are dropped. Throws
  // std::runtime_error with the names of all topics if there is no such topic.
  TopicStream(const dds::Participant& participant, const std::string& vehicle, const std::string& topic,
              std::size_t capacity = 4096);

  const std::vector<mcap::Column>& columns() const { return decoder_.columns(); }

  // The oldest sample that waits, else the next one that arrives; nullopt if none does in this time.
  std::optional<Sample> next(std::chrono::milliseconds timeout);

  std::uint64_t dropped() const;

 private:
  void receive(const dds::RawSample& sample);

  const mcap::MessageDecoder decoder_;
  const std::size_t capacity_;
  mutable std::mutex mutex_;  // guards the following three
  std::condition_variable arrived_;
  std::deque<Sample> waiting_;
  std::uint64_t dropped_ = 0;
  dds::Node node_;
  dds::Subscription subscription_;  // last: its callback uses all members above
};

}  // namespace swiftlet::ground
