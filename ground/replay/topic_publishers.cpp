#include "swiftlet/ground/replay/topic_publishers.hpp"

#include <algorithm>
#include <memory>
#include <type_traits>

#include "swiftlet/services/dds/payload.hpp"
#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::ground {

TopicPublishers::TopicPublishers(dds::Node& node, const std::set<std::string>& names) {
  messages::for_each_topic([&](const auto& topic) {
    using Message = typename std::decay_t<decltype(topic)>::Message;
    if (names.count(topic.name) == 0) return;
    const auto publisher = std::make_shared<dds::Publisher<Message>>(node.publish(topic));
    topics_[topic.name] = {
        [publisher] { return publisher->matched() > 0; },
        [publisher](mcap::ByteView payload) {
          Message message;
          return dds::from_payload(payload.data, payload.size, message) && publisher->publish(message);
        },
        [publisher](std::chrono::milliseconds timeout) { return publisher->wait_until_received(timeout); }};
  });
}

bool TopicPublishers::matched() const {
  return std::all_of(topics_.begin(), topics_.end(),
                     [](const auto& topic) { return topic.second.matched(); });
}

bool TopicPublishers::publish(const std::string& name, mcap::ByteView payload) {
  const auto topic = topics_.find(name);
  return topic != topics_.end() && topic->second.publish(payload);
}

bool TopicPublishers::wait_until_received(const std::string& name, std::chrono::milliseconds timeout) {
  const auto topic = topics_.find(name);
  return topic == topics_.end() || topic->second.wait_until_received(timeout);
}

}  // namespace swiftlet::ground
