#include "swiftlet/services/mocap/sources/source_options.hpp"

#include <stdexcept>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/configuration.hpp"

namespace swiftlet::mocap {
namespace {

constexpr SourceKind kKinds[] = {SourceKind::kNatNet, SourceKind::kVrpn, SourceKind::kVicon,
                                 SourceKind::kReplay};

SourceKind kind_of(const std::string& name) {
  for (const SourceKind kind : kKinds) {
    if (name == to_string(kind)) return kind;
  }
  throw std::invalid_argument("--source is required without --room");
}

Room room_without_file(const SourceOptions& options, const std::vector<std::string>& vehicles) {
  Room room;
  room.source = kind_of(options.source);
  for (const std::string& vehicle : vehicles) {
    VehicleBody body;
    body.vehicle = vehicle;
    body.body = vehicle;
    room.vehicles.push_back(body);
  }
  return room;
}

Room room_with_file(const SourceOptions& options, const std::vector<std::string>& vehicles) {
  const std::string path = io::configuration_file(io::kinds::kRoom, options.room);
  Room room = load_room(path);
  for (const std::string& vehicle : vehicles) {
    if (find(room, vehicle) == nullptr)
      throw io::ConfigError(path, 0, "vehicles", "does not have the vehicle " + vehicle);
  }
  if (options.source.empty() || kind_of(options.source) == room.source) return room;
  room.source = kind_of(options.source);  // what is left of the other source is of no use
  room.server.clear();
  room.file.clear();
  return room;
}

// A tracker may have several sensors: without a number a vehicle is the first, in whatever order their poses come.
void choose_first_sensors(Room& room) {
  for (VehicleBody& vehicle : room.vehicles) {
    if (!vehicle.id) vehicle.id = 0;
  }
}

}  // namespace

void add_source_options(runtime::CommandLine app, SourceOptions& options, std::vector<std::string> first) {
  for (const SourceKind kind : kKinds) first.emplace_back(to_string(kind));
  app.add_option("--source", options.source, "Where poses come from; replaces that of the room")
      .one_of(first);
  app.add_option("--room", options.room, "Room file: source, axes, and which body is which vehicle")
      .type_name(io::kinds::kRoom.value);
  app.add_option("--server", options.server,
                 "Server of the motion capture: HOST or HOST:PORT. natnet looks for one without it")
      .type_name("HOST");
  app.add_option("--mocap-interface", options.interface,
                 "Network interface towards the motion capture, by name or address")
      .type_name("INTERFACE");
  app.add_option("--frame", options.frame, "Axes of the motion capture: z up, or y up")
      .one_of({"zup", "yup"});
  app.add_option("--file", options.file, "Recording to replay: pcap or pcapng of NatNet, or CSV of poses")
      .type_name("FILE");
}

Room room_of(const SourceOptions& options, const std::vector<std::string>& vehicles) {
  Room room = options.room.empty() ? room_without_file(options, vehicles) : room_with_file(options, vehicles);
  if (!options.server.empty()) room.server = options.server;
  if (!options.interface.empty()) room.interface = options.interface;
  if (!options.frame.empty()) room.axes = options.frame == "yup" ? Axes::kYUp : Axes::kZUp;
  if (!options.file.empty()) room.file = options.file;
  if (room.source == SourceKind::kReplay && room.file.empty())
    throw std::invalid_argument("--source replay needs --file");
  if (room.source != SourceKind::kReplay && !room.file.empty())
    throw std::invalid_argument("--file: only with --source replay");
  if (room.source == SourceKind::kVrpn && room.server.empty())
    throw std::invalid_argument("--source vrpn needs --server");
  if (room.source == SourceKind::kVrpn) choose_first_sensors(room);
  return room;
}

}  // namespace swiftlet::mocap
