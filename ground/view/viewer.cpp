#include "swiftlet/ground/view/viewer.hpp"

#include <exception>
#include <utility>

#include <fmt/core.h>

namespace swiftlet::ground {

// What is wrong with one message: at most kMostRefusals of it are told.
class Viewer::Refusals {
 public:
  explicit Refusals(Viewer& viewer) : viewer_(viewer) {}

  void add(const std::string& why) {
    if (count_++ < kMostRefusals) viewer_.reply(foxglove::status(foxglove::Level::kError, why));
  }

 private:
  Viewer& viewer_;
  std::size_t count_ = 0;
};

Viewer::~Viewer() {
  for (const auto& [subscription, channel] : channels_) topics_.release(channel);
}

void Viewer::take(const foxglove::Subscribe& message) {
  Refusals refusals(*this);
  for (const auto& [id, channel] : message.subscriptions) {
    if (channel >= topics_.channels().size()) {
      refusals.add(fmt::format("subscribe: there is no channel {}", channel));
    } else if (channels_.count(id) > 0) {
      refusals.add(fmt::format("subscribe: subscription {} exists", id));
    } else if (subscriptions_.count(channel) > 0) {
      refusals.add(
          fmt::format("subscribe: channel {} has subscription {} already", channel, subscriptions_[channel]));
    } else {
      try {
        const std::vector<LiveTopics::Live> first = topics_.use(channel);
        channels_[id] = channel;
        subscriptions_[channel] = id;
        for (const LiveTopics::Live& live : first) put(channel, live);
      } catch (const std::exception& error) {
        refusals.add(fmt::format("subscribe: channel {}: {}", channel, error.what()));
      }
    }
  }
}

void Viewer::take(const foxglove::Unsubscribe& message) {
  Refusals refusals(*this);
  for (const std::uint32_t id : message.subscriptions) {
    const auto known = channels_.find(id);
    if (known == channels_.end()) {
      refusals.add(fmt::format("unsubscribe: there is no subscription {}", id));
      continue;
    }
    topics_.release(known->second);
    subscriptions_.erase(known->second);
    channels_.erase(known);
    queue_.forget(id);
  }
}

void Viewer::reply(const std::string& text) {
  replies_.push_back({true, mcap::Bytes(text.begin(), text.end()), nullptr});
}

void Viewer::reply(mcap::Bytes binary) { replies_.push_back({false, std::move(binary), nullptr}); }

void Viewer::put(std::uint32_t channel, const LiveTopics::Live& live) {
  const auto known = subscriptions_.find(channel);
  if (known != subscriptions_.end()) queue_.put({known->second, live.time_ns, live.payload, live.is_event});
}

std::optional<Outgoing> Viewer::next() {
  if (!replies_.empty()) {
    Outgoing reply = std::move(replies_.front());
    replies_.pop_front();
    return reply;
  }
  const std::optional<Frame> frame = queue_.take();
  if (!frame) return std::nullopt;
  const foxglove::MessageHead head = foxglove::message_head(frame->subscription, frame->time_ns);
  return Outgoing{false, mcap::Bytes(head.begin(), head.end()), frame->payload};
}

}  // namespace swiftlet::ground
