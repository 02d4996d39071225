#include "swiftlet/ground/view/live_topics.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <utility>

#include "swiftlet/services/messages/topics.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kQueueBytes = std::size_t{8} << 20U;
constexpr std::size_t kLogLines = 50;  // of a vehicle, for viewers that come later

}  // namespace

struct LiveTopics::Vehicle {
  Vehicle(const dds::Participant& participant, const std::string& its_name)
      : name(its_name), node(participant, its_name), standard(its_name) {}

  const std::string name;
  dds::Node node;
  record::StandardMessages standard;
};

// A topic of a vehicle.
struct LiveTopics::Source {
  Vehicle* vehicle = nullptr;
  std::string topic;  // "imu"
  std::uint32_t channel = 0;
  std::uint16_t number = 0;
  std::function<dds::Subscription(Source&)> subscribe;
  std::atomic<std::uint64_t> dropped{0};
  std::size_t users = 0;
  std::optional<dds::Subscription> subscription;  // while it has users
};

LiveTopics::LiveTopics(const Context& context) : participant_(context.participant()), queue_(kQueueBytes) {}

LiveTopics::~LiveTopics() = default;

std::uint32_t LiveTopics::add_channel(const std::string& topic, const messages::MessageSchema& schema) {
  const auto [known, is_new] = known_.try_emplace(topic, static_cast<std::uint32_t>(channels_.size()));
  if (is_new) {
    channels_.push_back({known->second, topic, &schema});
    states_.emplace_back();
  }
  return known->second;
}

template <class T>
void LiveTopics::add_topic(Vehicle& vehicle, const messages::Topic<T>& topic) {
  sources_.emplace_back();
  Source& source = sources_.back();
  source.vehicle = &vehicle;
  source.topic = topic.name;
  source.number = static_cast<std::uint16_t>(sources_.size() - 1);
  source.subscribe = [this, topic](Source& of) {
    return of.vehicle->node.subscribe_raw<T>(topic, [this, &of](const dds::RawSample& sample) {
      const std::int64_t now_ns = runtime::system_ns();
      if (!queue_.put({of.number,
                       static_cast<std::uint32_t>(sample.sequence_number),
                       now_ns,
                       now_ns,
                       {sample.payload, sample.size}}))
        ++of.dropped;
    });
  };
}

void LiveTopics::add_vehicle(const std::string& name) {
  const auto known = std::find_if(vehicles_.begin(), vehicles_.end(),
                                  [&](const Vehicle& vehicle) { return vehicle.name == name; });
  const bool is_new = known == vehicles_.end();
  Vehicle& vehicle = is_new ? vehicles_.emplace_back(participant_, name) : *known;
  if (is_new) add_topics(vehicle);
  for (const record::StandardTopic& standard : vehicle.standard.topics()) {
    const std::uint32_t channel = add_channel(standard.topic, *standard.schema);
    State& state = states_[channel];
    for (Source& source : sources_) {
      const bool follows =
          source.vehicle == &vehicle &&
          std::find(standard.sources.begin(), standard.sources.end(), source.topic) != standard.sources.end();
      if (!follows) continue;
      if (std::find(state.sources.begin(), state.sources.end(), &source) == state.sources.end()) {
        state.sources.push_back(&source);
        source.users += state.users;
      }
      if (source.users > 0 && !source.subscription) source.subscription = source.subscribe(source);
    }
    if (!standard.is_log || state.kept == kLogLines) continue;
    state.is_event = true;
    use(channel);
    state.kept = kLogLines;
  }
}

void LiveTopics::add_topics(Vehicle& vehicle) {
  messages::for_each_topic([&](const auto& topic) {
    using Message = typename std::decay_t<decltype(topic)>::Message;
    add_topic(vehicle, topic);
    Source& source = sources_.back();
    source.channel = add_channel("/" + vehicle.name + "/" + source.topic, messages::schema_of<Message>());
    states_[source.channel].sources.push_back(&source);
    states_[source.channel].is_event =
        topic.qos == messages::Qos::kRequest || topic.qos == messages::Qos::kReply;
  });
}

std::vector<LiveTopics::Live> LiveTopics::use(std::uint32_t channel) {
  State& state = states_.at(channel);
  for (Source* const source : state.sources) {
    if (!source->subscription) source->subscription = source->subscribe(*source);
  }
  for (Source* const source : state.sources) ++source->users;
  ++state.users;
  return {state.last.begin(), state.last.end()};
}

void LiveTopics::release(std::uint32_t channel) {
  State& state = states_.at(channel);
  if (--state.users == 0) state.last.clear();
  for (Source* const source : state.sources) {
    if (--source->users == 0) source->subscription.reset();
  }
}

void LiveTopics::take_all(const std::function<void(std::uint32_t, const Live&)>& take) {
  queue_.take_all(0ms, [&](const mcap::Message& message) {
    Source& source = sources_[message.channel_id];
    const auto hand_on = [&](std::uint32_t channel, mcap::Bytes payload) {
      State& state = states_[channel];
      if (state.users == 0) return;
      state.last.push_back(
          {message.log_time_ns, std::make_shared<const mcap::Bytes>(std::move(payload)), state.is_event});
      if (state.last.size() > state.kept) state.last.pop_front();
      take(channel, state.last.back());
    };
    const bool is_used = states_[source.channel].users > 0;
    if (is_used) hand_on(source.channel, {message.payload.data, message.payload.data + message.payload.size});
    if (source.users == states_[source.channel].users) return;  // no standard message is in use
    for (record::StandardMessage& follows : source.vehicle->standard.of(source.topic, message))
      hand_on(known_.at(follows.topic), std::move(follows.payload));
  });
}

std::uint64_t LiveTopics::dropped() const {
  std::uint64_t sum = 0;
  for (const Source& source : sources_) sum += source.dropped;
  return sum;
}

}  // namespace swiftlet::ground
