#include "swiftlet/ground/client/discovery.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace swiftlet::ground {
namespace {

constexpr const char* kRos = "rt/";
constexpr std::array<const char*, 6> kFromGround = {"command",     "mission",  "trajectory",
                                                    "ground_link", "setpoint", "simulation_clock"};

bool comes_from_ground(const std::string& topic) {
  return std::find(kFromGround.begin(), kFromGround.end(), topic) != kFromGround.end();
}

// Splits a DDS topic name into vehicle and topic. Returns false if it is not a vehicle's topic.
bool split(const std::string& wire_name, std::string& vehicle, std::string& topic) {
  const std::string prefix = kRos;
  const std::size_t slash = wire_name.find('/', prefix.size());
  if (wire_name.compare(0, prefix.size(), prefix) != 0 || slash == std::string::npos) return false;
  vehicle = wire_name.substr(prefix.size(), slash - prefix.size());
  topic = wire_name.substr(slash + 1);
  return topic.find('/') == std::string::npos;
}

}  // namespace

std::vector<std::string> vehicles_of(const std::vector<std::string>& wire_names) {
  std::set<std::string> vehicles;
  std::string vehicle, topic;
  for (const std::string& name : wire_names) {
    if (split(name, vehicle, topic) && !comes_from_ground(topic)) vehicles.insert(vehicle);
  }
  return {vehicles.begin(), vehicles.end()};
}

std::vector<std::string> topics_of(const std::string& of, const std::vector<std::string>& wire_names) {
  std::set<std::string> topics;
  std::string vehicle, topic;
  for (const std::string& name : wire_names) {
    if (split(name, vehicle, topic) && vehicle == of) topics.insert(topic);
  }
  return {topics.begin(), topics.end()};
}

std::string listed(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

}  // namespace swiftlet::ground
