#include "swiftlet/analysis/report/recorded_flights.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include <fmt/ranges.h>

#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/flat_yaml.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/record/evaluation.hpp"
#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/record/mcap/attached_file.hpp"

namespace swiftlet::analysis {
namespace {

namespace fs = std::filesystem;

constexpr const char* kReport = "report.json";
constexpr std::array kSettings = {"control", "mission", "simulation", "vehicle"};

// The element that belongs to a vehicle of "kl1,kl2", of a value such as "square,zigzag".
std::string element_of(const std::map<std::string, std::string>& metadata, const char* list_key,
                       const std::string& vehicle) {
  const auto split = [&](const char* key) {
    const auto found = metadata.find(key);
    return found == metadata.end() ? std::vector<std::string>() : io::split_text(found->second, ',');
  };
  const std::vector<std::string> vehicles = split("vehicles");
  const std::vector<std::string> elements = split(list_key);
  const auto at =
      static_cast<std::size_t>(std::find(vehicles.begin(), vehicles.end(), vehicle) - vehicles.begin());
  return at < elements.size() ? elements[at] : "";
}

// At which the vehicle was commanded: by the topics of the commands. Several are joined by commas.
std::string levels_of(const mcap::Reader& file, const std::string& vehicle) {
  constexpr std::array<std::pair<const char*, const char*>, 4> kCommands = {
      {{"actuator_command", "actuators"},
       {"rates_setpoint", "rates"},
       {"attitude_setpoint", "attitude"},
       {"trajectory_setpoint", "trajectory"}}};
  std::vector<std::string> levels;
  for (const auto& [id, count] : file.statistics().messages_by_channel) {
    for (const auto& [topic, level] : kCommands) {
      if (count > 0 && file.channels().at(id).topic == "/" + vehicle + "/" + topic)
        levels.emplace_back(level);
    }
  }
  return fmt::format("{}", fmt::join(levels, ","));
}

nlohmann::ordered_json report_of(const mcap::Reader& file, const std::string& vehicle,
                                 const record::Flight& flight) {
  const std::map<std::string, std::string> metadata = record::metadata_of(file, "swiftlet/flight");
  const record::Evaluation flown = record::evaluate(flight);
  nlohmann::ordered_json json;
  json["completed"] = flown.completed;
  if (!flown.completed)
    json["reason"] = flown.mission_id == 0  ? "no mission was flown"
                     : flown.reason.empty() ? "the file ends before the mission does"
                                            : flown.reason;
  for (const char* key : {"clock", "vehicle", "control", "seed"}) {
    const auto found = metadata.find(key);
    if (found != metadata.end()) json[key] = found->second;
  }
  if (const std::string model = element_of(metadata, "models", vehicle); !model.empty())
    json["vehicle"] = model;
  const std::string mission = element_of(metadata, "missions", vehicle);
  if (!mission.empty()) json["mission"] = mission;
  json["vehicle_name"] = vehicle;
  json["level"] = levels_of(file, vehicle);
  json["record"] = file.name();
  json["duration_s"] = flown.duration_s;
  json["matched_samples"] = flown.errors.matched;
  if (flown.errors.matched > 0) {
    json["rms_3d_m"] = flown.errors.rms_3d_m;
    json["peak_3d_m"] = flown.errors.peak_3d_m;
  }
  return json;
}

// What `swiftlet fly` wrote beside the file knows more: timing, the tolerance, why a flight was not completed.
void add_written(const fs::path& report, nlohmann::ordered_json& json) {
  std::error_code none;
  if (!fs::exists(report, none)) return;
  const auto written = nlohmann::ordered_json::parse(io::read_text_file(report.string()), nullptr, false);
  if (!written.is_object()) throw io::ConfigError(report.string(), 0, "", "is not valid JSON");
  json.erase("reason");
  json.update(written);
}

std::vector<std::pair<std::string, std::string>> settings_of(const mcap::Reader& file,
                                                             const std::string& vehicle) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string kind : kSettings) {
    const std::string name = kind + ".yaml";
    const auto text = mcap::attached_file(file, vehicle, name);
    if (!text) continue;
    for (auto& [key, value] : io::flatten_yaml(*text, file.name() + "/" + name))
      all.emplace_back(kind + "." + key, std::move(value));
  }
  return all;
}

}  // namespace

std::vector<RecordedFlight> load_record(const fs::path& record) {
  const record::FlightFile from = record::flight_file(record);
  const mcap::Reader file(from.file.string());
  const bool in_folder = from.file.filename() == record::kFlightFile;
  const fs::path folder = fs::absolute(from.file).parent_path();
  const fs::path name = in_folder ? folder.filename() : from.file.filename();
  std::map<std::string, record::Flight> flights = record::read_flights(file);
  if (flights.empty()) (void)record::recorded_vehicle(file, "");  // says so
  std::vector<RecordedFlight> loaded;
  for (const std::string& vehicle : record::recorded_vehicles(file)) {
    if (!from.vehicle.empty() && vehicle != from.vehicle) continue;
    RecordedFlight flight;
    flight.record = record;
    flight.name = flights.size() > 1 ? name / vehicle : name;
    flight.report = report_of(file, vehicle, flights.at(vehicle));
    if (in_folder)
      add_written(flights.size() > 1 ? folder / vehicle / kReport : folder / kReport, flight.report);
    flight.settings = settings_of(file, vehicle);
    flight.vehicle = vehicle;
    flight.file = from.file;
    flight.flown = std::move(flights.at(vehicle));
    loaded.push_back(std::move(flight));
  }
  return loaded;
}

fs::path newest_record(const fs::path& below) {
  std::optional<fs::path> newest;
  fs::file_time_type newest_time;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(below, none)) {
    const fs::path file = entry.path() / record::kFlightFile;
    if (!fs::exists(file, none)) continue;
    const fs::file_time_type time = fs::last_write_time(file, none);
    if (newest && time <= newest_time) continue;
    newest = entry.path();
    newest_time = time;
  }
  if (!newest)
    throw io::InputError(below.string() + ": contains no flight record; pass the folder of a record");
  return *newest;
}

}  // namespace swiftlet::analysis
