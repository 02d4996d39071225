#include "swiftlet/ground/cli/mocap/recorded_motion.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "swiftlet/analysis/logs/flight_log_files.hpp"
#include "swiftlet/ground/cli/check/sample_recorder.hpp"
#include "swiftlet/ground/cli/mocap/mocap_commands.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/record/file/flight_reader.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;
using identification::FlightLog;
using namespace std::chrono_literals;

constexpr double kLongestSilence_s = 10.0;
constexpr double kSlowest = 10.0;  // real time in that of the vehicle

void add_imu(FlightLog& log, double time_s, const Eigen::Vector3d& force, const Eigen::Vector3d& rates) {
  if (!log.time_s.empty() && time_s <= log.time_s.back()) return;
  log.time_s.push_back(time_s);
  log.specific_force_frd.push_back(force);
  log.body_rates_frd.push_back(rates);
}

void add_pose(FlightLog& log, const identification::FlightPose& pose) {
  if (log.poses.empty() || pose.time_s > log.poses.back().time_s) log.poses.push_back(pose);
}

FlightLog read_mcap(const std::string& name, const std::string& vehicle) {
  const mcap::Reader file(name);
  const record::Flight flight = record::read_flight(file, record::recorded_vehicle(file, vehicle));
  FlightLog log;
  log.name = name;
  for (const plant::ImuSample& imu : flight.imu)
    add_imu(log, math::seconds(imu.stamp_ns), imu.specific_force_frd, imu.body_rates_frd);
  for (const plant::PoseSample& pose : flight.poses) {
    if (pose.tracked)
      add_pose(log, {math::seconds(pose.stamp_ns), pose.position_ned, pose.q_ned_from_frd.normalized()});
  }
  return log;
}

FlightLog cut(const FlightLog& log, double from_s, double until_s) {
  FlightLog out;
  out.name = log.name;
  const auto is_inside = [&](double time_s) { return time_s >= from_s && time_s <= until_s; };
  for (std::size_t row = 0; row < log.size(); ++row) {
    if (is_inside(log.time_s[row]))
      add_imu(out, log.time_s[row], log.specific_force_frd[row], log.body_rates_frd[row]);
  }
  for (const identification::FlightPose& pose : log.poses) {
    if (is_inside(pose.time_s)) add_pose(out, pose);
  }
  return out;
}

}  // namespace

FlightLog read_motion(const std::string& file, const std::string& vehicle, std::optional<double> from_s,
                      std::optional<double> until_s) {
  FlightLog log;
  const record::FlightFile from = record::flight_file(file);
  const fs::path& path = from.file;
  if (!from.vehicle.empty() && from.vehicle != vehicle)
    throw io::ConfigError(file, 0, "", "is a flight of " + from.vehicle + ", not of " + vehicle);
  if (path.extension() == ".mcap") {
    log = read_mcap(path.string(), vehicle);
  } else {
    // The commands, which a vehicle file translates, are not used.
    const plant::Vehicle any = io::load_vehicle(io::configuration_file(io::kinds::kVehicle, "kaylion"));
    log = analysis::read_flight_log(path, any, analysis::BodyAxes::kDetected).log;
  }
  if (log.poses.empty())
    throw std::runtime_error(file +
                             " has no poses of the motion capture; a calibration needs them and the IMU");
  constexpr double kEver_s = std::numeric_limits<double>::infinity();
  return cut(log, from_s.value_or(-kEver_s), until_s.value_or(kEver_s));
}

FlightLog receive_motion(const dds::NodeSettings& settings, double time_s, runtime::StopSignal& stop) {
  SampleRecorder recorder(settings);
  const auto interrupted = [&] { return is_interrupted(stop); };
  const auto record = [&](std::chrono::milliseconds time) {
    if (!recorder.record(time, interrupted)) throw std::runtime_error("mocap calibrate: interrupted");
  };
  const auto missing = [&](const char* topic) {
    return std::runtime_error(
        fmt::format("no {} of {} arrived in {:g} s", topic, settings.vehicle, kLongestSilence_s));
  };
  const auto begin = std::chrono::steady_clock::now();
  while (!recorder.newest_imu() || !recorder.newest_tracked_pose()) {
    record(50ms);
    if (std::chrono::steady_clock::now() - begin > std::chrono::duration<double>(kLongestSilence_s))
      throw missing(recorder.newest_imu() ? "tracked mocap_pose" : "imu");
  }
  recorder.restart();
  std::optional<std::int64_t> first_ns;
  double recorded_s = 0.0;
  const auto end = std::chrono::steady_clock::now() + kSlowest * std::chrono::duration<double>(time_s);
  while (recorded_s < time_s && std::chrono::steady_clock::now() < end) {
    record(50ms);
    if (1e-9 * static_cast<double>(recorder.imu_silence_ns()) > kLongestSilence_s) throw missing("imu");
    if (const auto imu = recorder.newest_imu()) {
      first_ns = first_ns.value_or(imu->imu.stamp_ns);
      recorded_s = 1e-9 * static_cast<double>(imu->imu.stamp_ns - *first_ns);
    }
  }
  const VehicleRecording recording = recorder.recording();
  FlightLog log;
  log.name = settings.vehicle;
  for (const auto& received : recording.imu.samples) {
    const plant::ImuSample& imu = received.sample.imu;
    add_imu(log, 1e-9 * static_cast<double>(imu.stamp_ns), imu.specific_force_frd, imu.body_rates_frd);
  }
  for (const auto& received : recording.mocap.samples) {
    const plant::PoseSample& pose = received.sample;
    if (pose.tracked)
      add_pose(log, {1e-9 * static_cast<double>(pose.stamp_ns), pose.position_ned, pose.q_ned_from_frd});
  }
  return log;
}

}  // namespace swiftlet::ground
