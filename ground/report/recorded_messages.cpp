#include "swiftlet/ground/report/recorded_messages.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "swiftlet/ground/report/recorded_settings.hpp"
#include "swiftlet/io/logs/recorded_flight.hpp"
#include "swiftlet/recording/flight_window.hpp"
#include "swiftlet/services/dds/payload.hpp"
#include "swiftlet/services/messages/convert.hpp"

namespace swiftlet::ground {
namespace {

const MissionRow* first_started(const FlightRecord& record) {
  const auto* const found =
      std::find_if(record.mission.begin(), record.mission.end(), [](const MissionRow& row) {
        return control::is_under_way(static_cast<control::MissionState>(row.state));
      });
  return found == record.mission.end() ? nullptr : found;
}

// The mission as it was uploaded, or as the controller reports that it flies it.
std::optional<control::Mission> mission_in(const mcap::Reader& file, const std::string& vehicle,
                                           std::uint64_t id) {
  mcap::Selection selection;
  for (const auto& topic : {comms::topics::kMission, comms::topics::kFlownMission})
    selection.topics.insert("/" + vehicle + "/" + topic.name);
  mcap::Messages messages(file, selection);
  while (messages.next()) {
    comms::msg::Mission message;
    control::Mission mission;
    const mcap::ByteView payload = messages.message().payload;
    if (comms::from_payload(payload.data, payload.size, message) && message.id() == id &&
        !comms::from_message(message, mission) && !mission.items.empty())
      return mission;
  }
  return std::nullopt;
}

// Why the mission ended, as its last status says.
std::string last_reason(const mcap::Reader& file, const std::string& vehicle) {
  mcap::Selection selection;
  selection.topics.insert("/" + vehicle + "/" + comms::topics::kMissionStatus.name);
  mcap::Messages messages(file, selection);
  std::string reason;
  while (messages.next()) {
    comms::msg::MissionStatus status;
    const mcap::ByteView payload = messages.message().payload;
    if (comms::from_payload(payload.data, payload.size, status)) reason = status.reason().c_str();
  }
  return reason;
}

std::map<std::string, std::string> metadata_of(const mcap::Reader& file) {
  for (const mcap::Metadata& metadata : file.metadata()) {
    if (metadata.name == "swiftlet/flight") return metadata.values;
  }
  return {};
}

// The element that belongs to a vehicle of "kl1,kl2", of a value such as "square,zigzag".
std::string element_of(const std::map<std::string, std::string>& metadata, const char* list_key,
                       const std::string& vehicle) {
  const auto split = [&](const char* key) {
    std::vector<std::string> parts;
    const auto found = metadata.find(key);
    if (found == metadata.end()) return parts;
    std::string rest = found->second + ",";
    for (std::size_t end = 0; (end = rest.find(',')) != std::string::npos; rest.erase(0, end + 1))
      parts.push_back(rest.substr(0, end));
    return parts;
  };
  const std::vector<std::string> vehicles = split("vehicles");
  const std::vector<std::string> elements = split(list_key);
  const auto at =
      static_cast<std::size_t>(std::find(vehicles.begin(), vehicles.end(), vehicle) - vehicles.begin());
  return at < elements.size() ? elements[at] : "";
}

nlohmann::ordered_json report_of(const mcap::Reader& file, const std::string& vehicle) {
  const std::map<std::string, std::string> metadata = metadata_of(file);
  const FlownMission flown = flown_mission(file, vehicle);
  nlohmann::ordered_json json;
  json["completed"] = flown.completed;
  if (!flown.completed) json["reason"] = flown.flown ? flown.reason : "no mission was flown";
  for (const char* key : {"clock", "vehicle", "control", "seed"}) {
    const auto found = metadata.find(key);
    if (found != metadata.end()) json[key] = found->second;
  }
  if (const std::string model = element_of(metadata, "models", vehicle); !model.empty())
    json["vehicle"] = model;
  const std::string mission = element_of(metadata, "missions", vehicle);
  if (!mission.empty()) json["mission"] = mission;
  json["vehicle_name"] = vehicle;
  json["record"] = file.name();
  json["duration_s"] = flown.duration_s;
  json["matched_samples"] = flown.errors.matched;
  if (flown.errors.matched > 0) {
    json["rms_3d_m"] = flown.errors.rms_3d_m;
    json["peak_3d_m"] = flown.errors.peak_3d_m;
  }
  return json;
}

// The attachment of a kind: "control.yaml", or rather one of this vehicle, "kl2/mission.yaml".
std::vector<std::pair<std::string, std::string>> settings_of(const mcap::Reader& file,
                                                             const std::string& vehicle) {
  std::map<std::string, std::string> texts;
  for (const mcap::AttachmentIndex& index : file.attachments()) {
    const bool own = index.name.rfind(vehicle + "/", 0) == 0;
    const std::string name = own ? index.name.substr(vehicle.size() + 1) : index.name;
    if (own || texts.count(name) == 0) texts[name] = file.attachment(index).data;
  }
  return recorded_settings(file.name(), texts);
}

}  // namespace

FlownMission flown_mission(const mcap::Reader& file, const std::string& vehicle) {
  FlownMission flown;
  const std::unique_ptr<FlightRecord> record = read_flight_record(file, vehicle);
  const MissionRow* const first = first_started(*record);
  const auto mission = first == nullptr ? std::nullopt : mission_in(file, vehicle, first->mission_id);
  const auto window =
      mission ? mission_window(*record, first->mission_id, *mission) : std::optional<Window>();
  flown.flown = window.has_value();
  flown.completed = std::any_of(record->mission.begin(), record->mission.end(), [&](const MissionRow& row) {
    return first != nullptr && row.mission_id == first->mission_id &&
           static_cast<control::MissionState>(row.state) == control::MissionState::kCompleted;
  });
  if (!flown.completed) flown.reason = last_reason(file, vehicle);
  if (!flown.completed && flown.reason.empty()) flown.reason = "the file ends before the mission does";
  if (window) flown.duration_s = mission_duration_s(*record, first->mission_id, *window);
  flown.errors = tracking_errors(record->truth, record->reference, window.value_or(Window{}),
                                 TruthSource::kInterpolated);
  return flown;
}

std::vector<RecordedFlight> load_recorded_messages(const std::filesystem::path& path) {
  const mcap::Reader file(path.string());
  const std::vector<std::string> vehicles = recorded_vehicles(file);
  if (vehicles.empty()) (void)recorded_vehicle(file, "");  // says so
  std::vector<RecordedFlight> flights;
  for (const std::string& vehicle : vehicles) {
    RecordedFlight flight;
    flight.folder = path;
    flight.name = vehicles.size() > 1 ? path.filename() / vehicle : path.filename();
    flight.report = report_of(file, vehicle);
    flight.settings = settings_of(file, vehicle);
    flights.push_back(std::move(flight));
  }
  return flights;
}

}  // namespace swiftlet::ground
