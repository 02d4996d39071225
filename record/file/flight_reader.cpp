#include "swiftlet/record/file/flight_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/natural_order.hpp"
#include "swiftlet/record/file/recorded_faults.hpp"
#include "swiftlet/record/mcap/series.hpp"
#include "swiftlet/record/mcap/topic_decoder.hpp"

namespace swiftlet::record {
namespace {

using io::ConfigError;
using mcap::Series;

constexpr const char* kTypes = "swiftlet_msgs/msg/";
constexpr double kUnitTolerance = 0.01;

// A member of N numbers: "position_ned[0]" and so on. kNotGiven if the messages have no such member.
template <std::size_t N>
class Numbers {
 public:
  Numbers(const Series& series, const std::string& name) {
    for (std::size_t i = 0; i < N; ++i)
      columns_[i] = series.find_numbers(N == 1 ? name : name + "[" + std::to_string(i) + "]");
  }

  std::array<double, N> at(std::size_t row) const {
    std::array<double, N> values;
    for (std::size_t i = 0; i < N; ++i) values[i] = columns_[i] == nullptr ? kNotGiven : (*columns_[i])[row];
    return values;
  }
  double operator[](std::size_t row) const { return at(row)[0]; }
  // 0 for what is no number of this type.
  template <class Integer = int>
  Integer integer(std::size_t row) const {
    const double value = (*this)[row];
    const bool fits = value >= static_cast<double>(std::numeric_limits<Integer>::min()) &&
                      value < static_cast<double>(std::numeric_limits<Integer>::max());
    return fits ? static_cast<Integer>(value) : Integer{0};
  }

 private:
  std::array<const std::vector<double>*, N> columns_;
};
using Number = Numbers<1>;

// A member without which the messages say nothing. Throws ConfigError if they do not have it.
template <std::size_t N>
class Required : public Numbers<N> {
 public:
  Required(const Series& series, const std::string& name) : Numbers<N>(series, name) {
    (void)series.numbers(N == 1 ? name : name + "[0]");
  }
};

class Text {
 public:
  Text(const Series& series, const std::string& name) : column_(series.find_texts(name)) {}
  std::string operator[](std::size_t row) const { return column_ == nullptr ? "" : (*column_)[row]; }

 private:
  const std::vector<std::string>* column_;
};

template <std::size_t N>
bool finite(const std::array<double, N>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

Eigen::Vector3d as_vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

template <class Row>
bool rises(const std::vector<Row>& rows, std::int64_t stamp_ns) {
  return rows.empty() || stamp_ns > rows.back().stamp_ns;
}
// True unless the last row is newer: for messages that are sent again when they change.
template <class Row>
bool is_not_older(const std::vector<Row>& rows, std::int64_t stamp_ns) {
  return rows.empty() || stamp_ns >= rows.back().stamp_ns;
}

void read_truth(const Series& series, Flight& flight) {
  flight.truth.reserve(series.size());
  const Required<3> position(series, "position_ned"), velocity(series, "velocity_ned");
  const Numbers<3> rates(series, "body_rates_frd");
  const Numbers<4> attitude(series, "q_ned_from_frd");
  const Numbers<8> speeds(series, "rotor_speeds");
  const Number rotors(series, "rotor_count"), voltage(series, "supply_voltage_v"),
      on_ground(series, "on_ground");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::int64_t stamp_ns = series.stamp_ns()[i];
    if (!rises(flight.truth, stamp_ns) || !finite(position.at(i)) || !finite(velocity.at(i))) continue;
    flight.truth.push_back({stamp_ns, position.at(i), velocity.at(i), attitude.at(i), rates.at(i),
                            speeds.at(i), rotors.integer(i), voltage[i], on_ground[i] != 0.0});
  }
}

void read_reference(const Series& series, Flight& flight) {
  flight.reference.reserve(series.size());
  const Number mode(series, "mode"), yaw(series, "yaw"), thrust(series, "thrust_setpoint");
  const Required<3> position(series, "position_ned"), velocity(series, "velocity_ned");
  const Numbers<3> acceleration(series, "acceleration_ned"), moment(series, "moment_setpoint");
  const Numbers<4> attitude(series, "attitude_setpoint");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::int64_t stamp_ns = series.stamp_ns()[i];
    if (!rises(flight.reference, stamp_ns) || !finite(position.at(i)) || !finite(velocity.at(i))) continue;
    flight.reference.push_back({stamp_ns, mode.integer(i), position.at(i), velocity.at(i), acceleration.at(i),
                                yaw[i], attitude.at(i), thrust[i], moment.at(i)});
  }
}

void read_estimate(const Series& series, Flight& flight) {
  flight.estimate.reserve(series.size());
  const Required<3> position(series, "position_ned"), velocity(series, "velocity_ned");
  const Numbers<3> rates(series, "body_rates_frd"), gyro_bias(series, "gyro_bias"),
      accelerometer_bias(series, "accelerometer_bias");
  const Numbers<4> attitude(series, "q_ned_from_frd");
  const Numbers<15> deviation(series, "standard_deviation");
  const Number pose_age(series, "pose_age_s"), fault(series, "pose_fault"),
      accepted(series, "poses_accepted"), refused(series, "poses_refused"), resets(series, "resets");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::int64_t stamp_ns = series.stamp_ns()[i];
    if (!rises(flight.estimate, stamp_ns) || !finite(position.at(i)) || !finite(velocity.at(i))) continue;
    flight.estimate.push_back({stamp_ns, position.at(i), velocity.at(i), attitude.at(i), rates.at(i),
                               gyro_bias.at(i), accelerometer_bias.at(i), deviation.at(i), pose_age[i],
                               fault.integer(i), accepted[i], refused[i], resets[i]});
  }
}

void read_mission(const Series& series, Flight& flight) {
  const std::vector<std::uint64_t>& id = series.integers("mission_id");
  const Number state(series, "state"), item(series, "item_index"), items(series, "item_count");
  const Text reason(series, "reason");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::int64_t stamp_ns = series.stamp_ns()[i];
    if (is_not_older(flight.mission, stamp_ns))
      flight.mission.push_back({stamp_ns, id[i], state.integer(i), item.integer<std::uint32_t>(i),
                                items.integer<std::uint32_t>(i), reason[i]});
  }
}

void read_imu(const Series& series, Flight& flight) {
  flight.imu.reserve(series.size());
  const Number sequence(series, "sequence_number");
  const Required<3> force(series, "specific_force_frd"), rates(series, "body_rates_frd");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::int64_t stamp_ns = series.stamp_ns()[i];
    if (!rises(flight.imu, stamp_ns) || !finite(force.at(i)) || !finite(rates.at(i))) continue;
    flight.imu.push_back(
        {stamp_ns, sequence.integer<std::uint64_t>(i), as_vector(force.at(i)), as_vector(rates.at(i))});
    flight.imu_sent_ns.push_back(series.publish_time_ns()[i]);
  }
}

void read_poses(const Series& series, Flight& flight) {
  const Number sequence(series, "sequence_number"), tracked(series, "tracked");
  const Required<3> position(series, "position_ned");
  const Required<4> attitude(series, "q_ned_from_frd");
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (sequence[i] == 0.0) continue;  // a heartbeat of motion capture without a pose
    const std::array<double, 4> q = attitude.at(i);
    plant::PoseSample pose;
    pose.stamp_ns = series.stamp_ns()[i];
    pose.sequence = sequence.integer<std::uint64_t>(i);
    pose.tracked = tracked[i] != 0.0;
    pose.position_ned = as_vector(position.at(i));
    pose.q_ned_from_frd = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    const bool valid = finite(position.at(i)) && std::abs(pose.q_ned_from_frd.norm() - 1.0) <= kUnitTolerance;
    if (rises(flight.poses, pose.stamp_ns) && (valid || !pose.tracked)) flight.poses.push_back(pose);
  }
}

void read_battery(const Series& series, Flight& flight) {
  const Number sequence(series, "sequence_number"), voltage(series, "voltage_v"),
      current(series, "current_a"), charge(series, "state_of_charge");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::int64_t stamp_ns = series.stamp_ns()[i];
    if (rises(flight.batteries, stamp_ns) && std::isfinite(voltage[i]))
      flight.batteries.push_back(
          {stamp_ns, sequence.integer<std::uint64_t>(i), voltage[i], current[i], charge[i]});
  }
}

void read_rotor_speeds(const Series& series, Flight& flight) {
  flight.rotor_speeds.reserve(series.size());
  const Number sequence(series, "sequence_number"), rotors(series, "rotor_count");
  const Numbers<8> speeds(series, "speeds");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::int64_t stamp_ns = series.stamp_ns()[i];
    if (rises(flight.rotor_speeds, stamp_ns) && finite(speeds.at(i)))
      flight.rotor_speeds.push_back(
          {stamp_ns, sequence.integer<std::uint64_t>(i), rotors.integer(i), speeds.at(i)});
  }
}

void read_commands(const Series& series, Flight& flight) {
  flight.commands.reserve(series.size());
  const Number sequence(series, "sequence_number"), imu(series, "imu_sequence_number"),
      mocap(series, "mocap_sequence_number"), state(series, "rotor_state"), rotors(series, "rotor_count");
  const Required<8> throttle(series, "throttle");
  for (std::size_t i = 0; i < series.size(); ++i) {
    plant::ActuatorCommand command;
    command.stamp_ns = series.stamp_ns()[i];
    if (!rises(flight.commands, command.stamp_ns) || !finite(throttle.at(i))) continue;
    command.sequence = sequence.integer<std::uint64_t>(i);
    command.imu_sequence = imu.integer<std::uint64_t>(i);
    command.mocap_sequence = mocap.integer<std::uint64_t>(i);
    command.rotor_state = state[i] != 0.0 ? plant::RotorState::kRunning : plant::RotorState::kOff;
    command.rotor_count = std::min(rotors.integer(i), plant::kMaxRotors);
    command.throttle = throttle.at(i);
    flight.commands.push_back(command);
    flight.commands_sent_ns.push_back(series.publish_time_ns()[i]);
  }
}

void read_status(const Series& series, Flight& flight) {
  const Number mode(series, "mode"), low(series, "low_battery_voltage_v"),
      critical(series, "critical_battery_voltage_v"), saturated(series, "saturated"),
      step(series, "step_time_max_us"), jitter(series, "period_jitter_p99_us"),
      delay_p50(series, "loop_delay_p50_s"), delay_p95(series, "loop_delay_p95_s"),
      margin(series, "delay_margin_s");
  const Text reason(series, "reason"), conflict(series, "source_conflict"),
      refusal(series, "setpoint_refusal");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::int64_t stamp_ns = series.stamp_ns()[i];
    if (is_not_older(flight.status, stamp_ns))
      flight.status.push_back({stamp_ns, mode.integer(i), reason[i], conflict[i], refusal[i], low[i],
                               critical[i], saturated[i], step[i], jitter[i], delay_p50[i], delay_p95[i],
                               margin[i]});
  }
}

void read_vehicle(const Series& series, Flight& flight) {
  const Text name(series, "name"), fault(series, "fault");
  const Number p50(series, "sense_to_actuate_p50_us"), p99(series, "sense_to_actuate_p99_us"),
      max(series, "sense_to_actuate_max_us");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::int64_t stamp_ns = series.stamp_ns()[i];
    if (is_not_older(flight.vehicle, stamp_ns))
      flight.vehicle.push_back({stamp_ns, name[i], fault[i], p50[i], p99[i], max[i]});
  }
}

void read_requests(const Series& series, Flight& flight) {
  const Number kind(series, "kind");
  for (std::size_t i = 0; i < series.size(); ++i)
    flight.requests.push_back({series.log_time_ns()[i], kind.integer(i)});
}

void read_answers(const Series& series, Flight& flight) {
  const Number accepted(series, "accepted");
  const Text reason(series, "reason");
  for (std::size_t i = 0; i < series.size(); ++i)
    flight.answers.push_back({series.log_time_ns()[i], 0, accepted[i] != 0.0, reason[i]});
}

using ReadTopic = void (*)(const Series&, Flight&);
const std::map<std::string, ReadTopic> kTopics = {{"ground_truth", read_truth},
                                                  {"reference", read_reference},
                                                  {"estimate", read_estimate},
                                                  {"mission_status", read_mission},
                                                  {"imu", read_imu},
                                                  {"mocap_pose", read_poses},
                                                  {"battery", read_battery},
                                                  {"rotor_speeds", read_rotor_speeds},
                                                  {"actuator_command", read_commands},
                                                  {"control_status", read_status},
                                                  {"vehicle_info", read_vehicle},
                                                  {"command", read_requests},
                                                  {"command_ack", read_answers}};

struct TopicName {
  std::string vehicle;
  std::string name;
};

// "/kl1/imu"; nullopt for a topic of no vehicle.
std::optional<TopicName> topic_name(const std::string& topic) {
  const std::size_t end = topic.rfind('/');
  if (end == std::string::npos || end == 0) return std::nullopt;
  return TopicName{topic.substr(1, end - 1), topic.substr(end + 1)};
}

std::int64_t least_delay_ns(const Series& series) {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (std::size_t i = 0; i < series.size(); ++i)
    least = std::min(least, series.log_time_ns()[i] - series.stamp_ns()[i]);
  return least;
}

std::map<std::string, Flight> read(const mcap::Reader& file, const std::set<std::string>& vehicles) {
  mcap::Selection selection;
  for (const auto& [id, channel] : file.channels()) {
    const auto topic = topic_name(channel.topic);
    if (topic && vehicles.count(topic->vehicle) > 0 && kTopics.count(topic->name) > 0 &&
        mcap::is_decodable(file, channel))
      selection.topics.insert(channel.topic);
  }
  std::map<std::string, Flight> flights;
  for (const std::string& vehicle : vehicles) flights[vehicle].faults = recorded_faults(file, vehicle);
  if (selection.topics.empty()) return flights;
  const auto is_of_message = [](const mcap::Column& column) {
    return column.name.find('.') == std::string::npos;  // not of one inside it
  };
  std::map<std::string, Series> all = mcap::read_series(file, selection, is_of_message);
  for (auto at = all.begin(); at != all.end(); at = all.erase(at)) {  // its memory serves the next one
    const Series& series = at->second;
    const auto topic = topic_name(at->first);
    Flight& flight = flights.at(topic->vehicle);
    (void)series.find_numbers("stamp_ns");  // or it is refused
    kTopics.at(topic->name)(series, flight);
    const bool tells_delay =
        topic->name == "estimate" || (topic->name == "ground_truth" && flight.estimate.empty());
    if (tells_delay && series.size() > 0) flight.log_minus_stamp_ns = least_delay_ns(series);
  }
  return flights;
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

FlightFile flight_file(const std::filesystem::path& record) {
  namespace fs = std::filesystem;
  std::error_code none;
  if (!fs::is_directory(record, none)) return {record, ""};
  fs::path folder = fs::absolute(record).lexically_normal();
  if (folder.filename().empty()) folder = folder.parent_path();
  if (fs::exists(folder / kFlightFile)) return {folder / kFlightFile, ""};
  if (fs::exists(folder / "report.json") && fs::exists(folder.parent_path() / kFlightFile))
    return {folder.parent_path() / kFlightFile, folder.filename()};
  throw ConfigError(record.string(), 0, "", "holds no flight.mcap, is not the record of a flight");
}

bool is_mcap(const std::filesystem::path& file) {
  std::array<char, mcap::kMagic.size()> head{};
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), head.size());
  return in && std::equal(head.begin(), head.end(), mcap::kMagic.begin(),
                          [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

std::vector<std::string> recorded_vehicles(const mcap::Reader& file) {
  std::set<std::string> vehicles;
  for (const auto& [id, channel] : file.channels()) {
    const mcap::Schema* const schema = file.schema_of(channel);
    const auto topic = topic_name(channel.topic);
    const auto& counts = file.statistics().messages_by_channel;
    const auto count = counts.find(id);
    if (schema != nullptr && schema->name.rfind(kTypes, 0) == 0 && topic && count != counts.end() &&
        count->second > 0)
      vehicles.insert(topic->vehicle);
  }
  std::vector<std::string> names(vehicles.begin(), vehicles.end());
  std::sort(names.begin(), names.end(), io::comes_before);
  return names;
}

std::string recorded_vehicle(const mcap::Reader& file, const std::string& name) {
  const std::vector<std::string> vehicles = recorded_vehicles(file);
  if (vehicles.empty()) throw ConfigError(file.name(), 0, "", "has no messages of a vehicle");
  if (name.empty() && vehicles.size() > 1)
    throw ConfigError(file.name(), 0, "",
                      "has the vehicles " + listed(vehicles) + "; choose one with --vehicle-name");
  if (name.empty()) return vehicles.front();
  if (std::find(vehicles.begin(), vehicles.end(), name) == vehicles.end())
    throw ConfigError(file.name(), 0, "", "has no vehicle " + name + ", only " + listed(vehicles));
  return name;
}

std::map<std::string, Flight> read_flights(const mcap::Reader& file) {
  const std::vector<std::string> vehicles = recorded_vehicles(file);
  return read(file, {vehicles.begin(), vehicles.end()});
}

Flight read_flight(const mcap::Reader& file, const std::string& vehicle) {
  return std::move(read(file, {vehicle}).at(vehicle));
}

std::map<std::string, std::string> metadata_of(const mcap::Reader& file, const std::string& name) {
  for (const mcap::Metadata& metadata : file.metadata()) {
    if (metadata.name == name) return metadata.values;
  }
  return {};
}

}  // namespace swiftlet::record
