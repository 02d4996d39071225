#include "swiftlet/ground/client/topic_stream.hpp"

#include <stdexcept>
#include <type_traits>
#include <utility>

#include "swiftlet/services/messages/schemas.hpp"
#include "swiftlet/services/messages/topics.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::ground {
namespace {

mcap::MessageDecoder decoder_of(const std::string& name) {
  std::optional<mcap::MessageDecoder> decoder;
  std::string names;
  messages::for_each_topic([&](const auto& topic) {
    names += (names.empty() ? "" : ", ") + std::string(topic.name);
    if (name != topic.name) return;
    const messages::MessageSchema& schema =
        messages::schema_of<typename std::decay_t<decltype(topic)>::Message>();
    decoder.emplace(mcap::Schema{1, schema.name, "ros2msg", schema.definition});
  });
  if (!decoder) throw std::runtime_error("'" + name + "' is no topic of a vehicle. Topics: " + names);
  return *decoder;
}

}  // namespace

TopicStream::TopicStream(const dds::Participant& participant, const std::string& vehicle,
                         const std::string& topic, std::size_t capacity)
    : decoder_(decoder_of(topic)), capacity_(capacity), node_(participant, vehicle) {
  messages::for_each_topic([&](const auto& one) {
    if (topic == one.name)
      subscription_ = node_.subscribe_raw(one, [this](const dds::RawSample& sample) { receive(sample); });
  });
}

void TopicStream::receive(const dds::RawSample& raw) {
  Sample sample;
  sample.received_ns = runtime::system_ns();
  if (!decoder_.decode({raw.payload, raw.size}, sample.values)) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (waiting_.size() == capacity_) {
      waiting_.pop_front();
      ++dropped_;
    }
    waiting_.push_back(std::move(sample));
  }
  arrived_.notify_one();
}

std::optional<TopicStream::Sample> TopicStream::next(std::chrono::milliseconds timeout) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!arrived_.wait_for(lock, timeout, [this] { return !waiting_.empty(); })) return std::nullopt;
  Sample sample = std::move(waiting_.front());
  waiting_.pop_front();
  return sample;
}

std::uint64_t TopicStream::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

}  // namespace swiftlet::ground
