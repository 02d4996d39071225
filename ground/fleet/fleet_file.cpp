#include "swiftlet/ground/fleet/fleet_file.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/core.h>

#include "swiftlet/io/config.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;
using io::ConfigNode;

constexpr double kFurthest_m = 1000.0;
constexpr double kLargestRadius_m = 10.0;
constexpr int kHighestPriority = 100;

// A file beside the fleet file, or one of the configuration.
fs::path file_of(const ConfigNode& node, const io::ConfigurationKind& kind) {
  const std::string name = node.text();
  const fs::path beside = fs::path(node.file()).parent_path() / name;
  std::error_code error;
  if (fs::is_regular_file(beside, error)) return beside.lexically_normal();
  try {
    return io::configuration_file(kind, name);
  } catch (const io::ConfigError& fault) {
    node.fail(std::string("names no file: ") + fault.what());
  }
}

fs::path file_or(const ConfigNode& root, const char* key, const io::ConfigurationKind& kind,
                 const char* otherwise) {
  const auto node = root.find(key);
  return node ? file_of(*node, kind) : io::configuration_file(kind, otherwise);
}

double radius(const ConfigNode& node) { return node.number({0.0, kLargestRadius_m, true, false}); }

void read_member(const ConfigNode& node, const fs::path& vehicle_file, FleetFile& fleet) {
  node.allow({"name", "vehicle", "start_m", "mission", "origin", "priority"});
  FleetMember member;
  const ConfigNode name = node.at("name");
  member.name = name.text();
  if (const std::string fault = messages::fault_of_vehicle_name(member.name); !fault.empty())
    name.fail(fault);
  for (const FleetMember& other : fleet.vehicles) {
    if (other.name == member.name)
      name.fail("is '" + member.name + "', which another vehicle has: each needs a name of its own");
  }
  const std::vector<double> place = node.at("start_m").numbers(2, 2, io::between(-kFurthest_m, kFurthest_m));
  member.start_ned = io::ned_from(fleet.frame, {place[0], place[1], 0.0}).head<2>();
  const auto vehicle = node.find("vehicle");
  member.vehicle_file = vehicle ? file_of(*vehicle, io::kinds::kVehicle) : vehicle_file;
  member.mission_file = file_of(node.at("mission"), io::kinds::kMission);
  if (const auto origin = node.find("origin"))
    member.mission_at_start = origin->choice<bool>({{"common", false}, {"start", true}});
  if (const auto priority = node.find("priority"))
    member.priority = static_cast<int>(priority->integer(1, kHighestPriority));
  fleet.vehicles.push_back(std::move(member));
}

FleetFile read_fleet(const ConfigNode& root) {
  root.allow({"name", "description", "frame", "vehicle", "control", "simulation", "safety", "vehicles"});
  FleetFile fleet;
  fleet.file = root.file();
  const auto name = root.find("name");
  fleet.name = name ? name->text() : fleet.file.stem().string();
  if (name && (fleet.name.size() > 64 || fleet.name.find('/') != std::string::npos))
    name->fail("must be at most 64 characters and hold no /");
  if (const auto description = root.find("description")) fleet.description = description->text();
  fleet.frame = root.at("frame").choice<io::MissionFrame>(
      {{"ned", io::MissionFrame::kNed}, {"enu", io::MissionFrame::kEnu}});
  const fs::path vehicle = file_or(root, "vehicle", io::kinds::kVehicle, "kaylion");
  fleet.control_file = file_or(root, "control", io::kinds::kControl, "motor_lag");
  fleet.simulation_file = file_or(root, "simulation", io::kinds::kSimulation, "default");
  const ConfigNode safety = root.at("safety");
  safety.allow({"radius_xy_m", "radius_z_m"});
  fleet.safety = {radius(safety.at("radius_xy_m")), radius(safety.at("radius_z_m"))};
  const ConfigNode vehicles = root.at("vehicles");
  for (const char* key : {"name", "description", "frame", "vehicle", "control", "simulation", "safety"}) {
    const auto node = root.find(key);
    if (node && node->line() > vehicles.line())
      node->fail("stands after vehicles, must stand before them: a truncated file would lose it silently");
  }
  for (const ConfigNode& node : vehicles.items(1, kMostFleetVehicles)) read_member(node, vehicle, fleet);
  return fleet;
}

}  // namespace

FleetFile parse_fleet_file(std::string_view text, const std::string& file_name) {
  return read_fleet(io::parse_config(text, file_name));
}

FleetFile load_fleet_file(const std::string& path) {
  return parse_fleet_file(io::read_text_file(path), path);
}

}  // namespace swiftlet::ground
