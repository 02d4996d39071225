#include "swiftlet/io/logs/recorded_flight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/mcap/series.hpp"
#include "swiftlet/io/natural_order.hpp"

namespace swiftlet::ground {
namespace {

using mcap::Series;
using runtime::ConfigError;

constexpr const char* kTypes = "swiftlet_msgs/msg/";
constexpr double kUnitTolerance = 0.01;

// A signal with N elements: "position_ned[0]" and so on.
template <std::size_t N>
class Signal {
 public:
  Signal(const Series& series, const std::string& name) {
    for (std::size_t i = 0; i < N; ++i)
      columns_[i] = &series.numbers(N == 1 ? name : name + "[" + std::to_string(i) + "]");
  }

  std::array<double, N> at(std::size_t row) const {
    std::array<double, N> values;
    for (std::size_t i = 0; i < N; ++i) values[i] = (*columns_[i])[row];
    return values;
  }

 private:
  std::array<const std::vector<double>*, N> columns_;
};

class Scalar {
 public:
  Scalar(const Series& series, const std::string& name) : column_(series.numbers(name)) {}
  double at(std::size_t row) const { return column_[row]; }

 private:
  const std::vector<double>& column_;
};

template <std::size_t N>
bool finite(const std::array<double, N>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

Eigen::Vector3d vector(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

// The recorded topics of one vehicle.
class VehicleTopics {
 public:
  VehicleTopics(const mcap::Reader& file, const std::string& vehicle) : prefix_("/" + vehicle + "/") {
    mcap::Selection selection;
    for (const auto& [id, channel] : file.channels()) {
      const std::string& topic = channel.topic;
      if (topic.rfind(prefix_, 0) == 0 && kNames.count(topic.substr(prefix_.size())) > 0)
        selection.topics.insert(topic);
    }
    if (!selection.topics.empty()) series_ = mcap::read_series(file, selection);
  }

  // Null if the topic was not recorded.
  const Series* find(const std::string& name) const {
    const auto found = series_.find(prefix_ + name);
    return found == series_.end() ? nullptr : &found->second;
  }
  std::size_t longest() const {
    std::size_t rows = 0;
    for (const auto& [topic, series] : series_) rows = std::max(rows, series.size());
    return rows;
  }

 private:
  inline static const std::set<std::string> kNames = {"imu",          "actuator_command", "mocap_pose",
                                                      "battery",      "estimate",         "reference",
                                                      "rotor_speeds", "ground_truth",     "mission_status"};
  std::string prefix_;
  std::map<std::string, Series> series_;
};

template <class Row>
void append_rising(Track<Row>& track, const Row& row) {
  if (track.empty() || row.stamp_ns > track.back().stamp_ns) track.append(row);
}

void read_truth(const Series& series, Track<TruthRow>& track) {
  const Signal<3> position(series, "position_ned");
  const Signal<3> velocity(series, "velocity_ned");
  const Signal<4> attitude(series, "q_ned_from_frd");
  const Signal<3> rates(series, "body_rates_frd");
  const Signal<8> speeds(series, "rotor_speeds");
  const Scalar rotors(series, "rotor_count");
  const Scalar voltage(series, "supply_voltage_v");
  const Scalar on_ground(series, "on_ground");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const TruthRow row{series.stamp_ns()[i],
                       position.at(i),
                       velocity.at(i),
                       attitude.at(i),
                       rates.at(i),
                       speeds.at(i),
                       static_cast<int>(rotors.at(i)),
                       voltage.at(i),
                       on_ground.at(i) != 0.0};
    if (finite(row.position_ned) && finite(row.velocity_ned)) append_rising(track, row);
  }
}

void read_reference(const Series& series, Track<ReferenceRow>& track) {
  const Scalar mode(series, "mode");
  const Signal<3> position(series, "position_ned");
  const Signal<3> velocity(series, "velocity_ned");
  const Signal<3> acceleration(series, "acceleration_ned");
  const Scalar yaw(series, "yaw");
  const Signal<4> attitude(series, "attitude_setpoint");
  const Scalar thrust(series, "thrust_setpoint");
  const Signal<3> moment(series, "moment_setpoint");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const ReferenceRow row{series.stamp_ns()[i], static_cast<int>(mode.at(i)),
                           position.at(i),       velocity.at(i),
                           acceleration.at(i),   yaw.at(i),
                           attitude.at(i),       thrust.at(i),
                           moment.at(i)};
    if (finite(row.position_ned) && finite(row.velocity_ned)) append_rising(track, row);
  }
}

void read_estimate(const Series& series, Track<EstimateRow>& track) {
  const Signal<3> position(series, "position_ned");
  const Signal<3> velocity(series, "velocity_ned");
  for (std::size_t i = 0; i < series.size(); ++i) {
    const EstimateRow row{series.stamp_ns()[i], position.at(i), velocity.at(i)};
    if (finite(row.position_ned) && finite(row.velocity_ned)) append_rising(track, row);
  }
}

void read_mission(const Series& series, Track<MissionRow>& track) {
  const std::vector<std::uint64_t>& id = series.integers("mission_id");
  const Scalar state(series, "state");
  const Scalar item(series, "item_index");
  for (std::size_t i = 0; i < series.size(); ++i)
    track.append(
        {series.stamp_ns()[i], id[i], static_cast<int>(state.at(i)), static_cast<std::uint32_t>(item.at(i))});
}

void read_imu_series(const Series& series, Track<plant::ImuSample>& track) {
  const Scalar sequence(series, "sequence_number");
  const Signal<3> force(series, "specific_force_frd");
  const Signal<3> rates(series, "body_rates_frd");
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!finite(force.at(i)) || !finite(rates.at(i))) continue;
    append_rising(track, {series.stamp_ns()[i], static_cast<std::uint64_t>(sequence.at(i)),
                          vector(force.at(i)), vector(rates.at(i))});
  }
}

void read_pose_series(const Series& series, Track<plant::PoseSample>& track) {
  const Scalar sequence(series, "sequence_number");
  const Scalar tracked(series, "tracked");
  const Signal<3> position(series, "position_ned");
  const Signal<4> attitude(series, "q_ned_from_frd");
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (sequence.at(i) == 0.0) continue;  // a heartbeat of motion capture without a pose
    const std::array<double, 4> q = attitude.at(i);
    plant::PoseSample pose;
    pose.stamp_ns = series.stamp_ns()[i];
    pose.sequence = static_cast<std::uint64_t>(sequence.at(i));
    pose.tracked = tracked.at(i) != 0.0;
    pose.position_ned = vector(position.at(i));
    pose.q_ned_from_frd = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    const bool valid = finite(position.at(i)) && std::abs(pose.q_ned_from_frd.norm() - 1.0) <= kUnitTolerance;
    if (valid || !pose.tracked) append_rising(track, pose);
  }
}

void read_battery(const Series& series, Track<plant::BatterySample>& track) {
  const Scalar sequence(series, "sequence_number");
  const Scalar voltage(series, "voltage_v");
  const Scalar current(series, "current_a");
  const Scalar charge(series, "state_of_charge");
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!std::isfinite(voltage.at(i))) continue;
    append_rising(track, {series.stamp_ns()[i], static_cast<std::uint64_t>(sequence.at(i)), voltage.at(i),
                          current.at(i), charge.at(i)});
  }
}

void read_rotor_speed_series(const Series& series, Track<plant::RotorSpeedSample>& track) {
  const Scalar sequence(series, "sequence_number");
  const Scalar rotors(series, "rotor_count");
  const Signal<8> speeds(series, "speeds");
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!finite(speeds.at(i))) continue;
    append_rising(track, {series.stamp_ns()[i], static_cast<std::uint64_t>(sequence.at(i)),
                          static_cast<int>(rotors.at(i)), speeds.at(i)});
  }
}

void read_command_series(const Series& series, Track<plant::ActuatorCommand>& track) {
  const Scalar sequence(series, "sequence_number");
  const Scalar imu(series, "imu_sequence_number");
  const Scalar mocap(series, "mocap_sequence_number");
  const Scalar state(series, "rotor_state");
  const Scalar rotors(series, "rotor_count");
  const Signal<8> throttle(series, "throttle");
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!finite(throttle.at(i))) continue;
    plant::ActuatorCommand command;
    command.stamp_ns = series.stamp_ns()[i];
    command.sequence = static_cast<std::uint64_t>(sequence.at(i));
    command.imu_sequence = static_cast<std::uint64_t>(imu.at(i));
    command.mocap_sequence = static_cast<std::uint64_t>(mocap.at(i));
    command.rotor_state = state.at(i) != 0.0 ? plant::RotorState::kRunning : plant::RotorState::kOff;
    command.rotor_count = std::min(static_cast<int>(rotors.at(i)), plant::kMaxRotors);
    command.throttle = throttle.at(i);
    append_rising(track, command);
  }
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

}  // namespace

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
    const std::size_t end = channel.topic.rfind('/');
    const auto& counts = file.statistics().messages_by_channel;
    const auto count = counts.find(id);
    if (schema != nullptr && schema->name.rfind(kTypes, 0) == 0 && end != std::string::npos && end > 0 &&
        count != counts.end() && count->second > 0)
      vehicles.insert(channel.topic.substr(1, end - 1));
  }
  std::vector<std::string> names(vehicles.begin(), vehicles.end());
  std::sort(names.begin(), names.end(), runtime::comes_before);
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

std::unique_ptr<FlightRecord> read_flight_record(const mcap::Reader& file, const std::string& vehicle) {
  const VehicleTopics topics(file, vehicle);
  auto record = std::make_unique<FlightRecord>(topics.longest());
  record->sensors = std::make_unique<SensorRecord>(topics.longest());
  const auto read = [&](const char* name, auto* reader, auto& track) {
    if (const Series* const series = topics.find(name)) reader(*series, track);
  };
  read("ground_truth", read_truth, record->truth);
  read("reference", read_reference, record->reference);
  read("estimate", read_estimate, record->estimate);
  read("mission_status", read_mission, record->mission);
  read("imu", read_imu_series, record->sensors->imu);
  read("mocap_pose", read_pose_series, record->sensors->poses);
  read("battery", read_battery, record->sensors->batteries);
  read("rotor_speeds", read_rotor_speed_series, record->sensors->rotor_speeds);
  read("actuator_command", read_command_series, record->sensors->commands);
  return record;
}

}  // namespace swiftlet::ground
