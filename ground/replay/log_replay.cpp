#include "swiftlet/ground/replay/log_replay.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <optional>
#include <set>
#include <thread>

#include "swiftlet/ground/replay/topic_publishers.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;
using Steady = std::chrono::steady_clock;

constexpr auto kDiscoveryTime = 500ms;     // so that processes that run already receive the first message
constexpr auto kLongestSleep = 50ms;       // between two looks at whether to go on
constexpr auto kReliableTimeout = 1000ms;  // for the last messages

struct Vehicle {
  std::string prefix;  // "/kl1/", of the file
  std::set<std::string> names;
  std::optional<dds::Node> node;
  std::optional<TopicPublishers> publishers;
};

// "/kl1/imu" -> "imu"; empty if the topic is of another vehicle.
std::string name_in(const Vehicle& vehicle, const std::string& topic) {
  const bool own = topic.rfind(vehicle.prefix, 0) == 0;
  return own ? topic.substr(vehicle.prefix.size()) : "";
}

bool selected(const mcap::Selection& selection, const std::string& topic) {
  return selection.topics.empty() || selection.topics.count(topic) > 0;
}

}  // namespace

ReplayTotals replay(const mcap::Reader& file, const dds::Participant& participant,
                    const ReplaySettings& settings, const std::function<bool(const ReplayTotals&)>& proceed) {
  std::deque<Vehicle> vehicles;
  for (const auto& [recorded, published] : settings.names) {
    Vehicle& vehicle = vehicles.emplace_back();
    vehicle.prefix = "/" + recorded + "/";
    for (const auto& [id, channel] : file.channels()) {
      const mcap::Schema* const schema = file.schema_of(channel);
      const std::string name = name_in(vehicle, channel.topic);
      if (schema != nullptr && schema->name.rfind("swiftlet_msgs/", 0) == 0 && !name.empty() &&
          selected(settings.selection, channel.topic))
        vehicle.names.insert(name);
    }
    vehicle.node.emplace(participant, published);
    vehicle.publishers.emplace(*vehicle.node, vehicle.names);
  }
  std::this_thread::sleep_for(kDiscoveryTime);

  ReplayTotals totals;
  mcap::Messages messages(file, settings.selection);
  const Steady::time_point begin = Steady::now();
  std::optional<std::int64_t> first_ns;
  while (messages.next()) {
    const mcap::Message& message = messages.message();
    const std::string& topic = messages.channel().topic;
    const auto owner = std::find_if(vehicles.begin(), vehicles.end(), [&](const Vehicle& vehicle) {
      return vehicle.names.count(name_in(vehicle, topic)) > 0;
    });
    if (owner == vehicles.end()) continue;
    if (!first_ns) first_ns = message.log_time_ns;
    totals.time_s = static_cast<double>(message.log_time_ns - *first_ns) * 1e-9;
    const Steady::time_point due = begin + std::chrono::duration_cast<Steady::duration>(
                                               std::chrono::duration<double>(totals.time_s / settings.speed));
    for (bool waited = false; !waited;) {
      if (!proceed(totals)) return totals;
      const Steady::time_point until = std::min(due, Steady::now() + kLongestSleep);
      std::this_thread::sleep_until(until);
      waited = until == due;
    }
    totals.largest_delay_s =
        std::max(totals.largest_delay_s, std::chrono::duration<double>(Steady::now() - due).count());
    if (owner->publishers->publish(name_in(*owner, topic), message.payload)) {
      ++totals.published;
    } else {
      ++totals.refused;
    }
  }
  for (Vehicle& vehicle : vehicles) {
    for (const std::string& name : vehicle.names)
      vehicle.publishers->wait_until_received(name, kReliableTimeout);
  }
  return totals;
}

}  // namespace swiftlet::ground
