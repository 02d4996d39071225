#include "swiftlet/ground/vehicle_check/standing_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/core.h>

#include "swiftlet/ground/vehicle_check/axes.hpp"
#include "swiftlet/ground/vehicle_check/checks.hpp"
#include "swiftlet/ground/vehicle_check/streams.hpp"

namespace swiftlet::ground {
namespace {

using Eigen::Vector3d;

struct Moments {
  Vector3d mean = Vector3d::Zero();
  double deviation = 0.0;  // standard, of the worst axis
};

template <class Value>
Moments moments(std::size_t count, Value value) {
  Moments moments;
  if (count == 0) return moments;
  Vector3d square = Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) moments.mean += value(i) / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) square += (value(i) - moments.mean).cwiseAbs2();
  moments.deviation = std::sqrt(square.maxCoeff() / static_cast<double>(count));
  return moments;
}

Moments force_moments(const VehicleRecording& recording) {
  const auto& samples = recording.imu.samples;
  return moments(samples.size(),
                 [&](std::size_t i) -> Vector3d { return samples[i].sample.imu.specific_force_frd; });
}
Moments rate_moments(const VehicleRecording& recording) {
  const auto& samples = recording.imu.samples;
  return moments(samples.size(),
                 [&](std::size_t i) -> Vector3d { return samples[i].sample.imu.body_rates_frd; });
}

// How many samples repeat the one before.
template <class Samples, class Repeats>
double repeated_percent(const Samples& samples, Repeats repeats) {
  std::size_t repeated = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) repeated += repeats(samples[i - 1], samples[i]) ? 1 : 0;
  return 1e2 * (static_cast<double>(repeated) / static_cast<double>(samples.size() - 1));
}

bool repeats_imu(const Received<ImuReport>& before, const Received<ImuReport>& now) {
  const plant::ImuSample& a = before.sample.imu;
  const plant::ImuSample& b = now.sample.imu;
  return a.sequence != b.sequence && a.specific_force_frd == b.specific_force_frd &&
         a.body_rates_frd == b.body_rates_frd;
}
bool repeats_pose(const plant::PoseSample& before, const plant::PoseSample& now) {
  return now.position_ned == before.position_ned &&
         now.q_ned_from_frd.coeffs() == before.q_ned_from_frd.coeffs();
}

CheckResult check_level(const Moments& force) {
  if (force.mean.norm() < 1e-3) return skipped(kImuLevel.name, "no gravity is measured");
  const Vector3d direction = force.mean.normalized();
  const double tilt_deg = angle_deg(direction, {0.0, 0.0, -1.0});
  Eigen::Index axis = 0;
  const double along = direction.cwiseAbs().maxCoeff(&axis);
  const std::string shown = std::string(direction(axis) > 0.0 ? "+" : "-") + "xyz"[axis];
  const Words words = {{"direction", to_string(direction, 2)}, {"axis", shown}};
  if (axis != 2 && along > std::cos(kImuLevel.most / math::kDegPerRad))
    return judge_by(kImuLevel, tilt_deg, "axes swapped: gravity is on {axis} instead of -z", words);
  return judge(kImuLevel, tilt_deg, words);
}

CheckResult check_gyro(const Moments& rates, bool still) {
  const double bias = rates.mean.norm();
  const bool noisy = rates.deviation > kGyroNoise_rad_s;
  std::string finding;
  if ((noisy || bias > kImuGyro.most) && still) {
    finding = std::string("gyro in degrees/s, or not calibrated: at rest its ") +
              (noisy ? "noise is {noise:.2f} instead of at most {most_noise:g}"
                     : "bias is {value:.2f} instead of at most {most:g}") +
              " rad/s; --hand tells which";
  } else if (noisy || bias > kImuGyro.most) {
    finding = "the gyro shows motion: the vehicle does not stand still";
  }
  return judge_by(kImuGyro, bias, finding, {{"noise", rates.deviation}, {"most_noise", kGyroNoise_rad_s}});
}

std::vector<plant::PoseSample> tracked_poses(const VehicleRecording& recording) {
  std::vector<plant::PoseSample> poses;
  for (const auto& received : recording.mocap.samples) {
    if (received.sample.tracked) poses.push_back(received.sample);
  }
  return poses;
}

// Direction of "up" in body axes: by the accelerometer and by motion capture.
CheckResult check_mocap_gravity(const std::vector<plant::PoseSample>& poses, const Vector3d& force) {
  const Moments up = moments(poses.size(), [&](std::size_t i) -> Vector3d {
    return poses[i].q_ned_from_frd.conjugate() * Vector3d(0.0, 0.0, -1.0);
  });
  return judge(kMocapGravity, angle_deg(up.mean, force));
}

CheckResults check_imu_at_rest(const VehicleRecording& recording) {
  if (recording.imu.samples.size() < kFewest) return {};
  const Moments force = force_moments(recording);
  const double size = force.mean.norm();
  const std::string against =
      fmt::format("|specific force| is {:.4g}, expected {:.2f} m/s^2", size, plant::kGravity);
  return {judge(kImuValues, repeated_percent(recording.imu.samples, repeats_imu)),
          judge(kImuStill, force.deviation),
          judge(kImuGravity, size, {{"gravity", plant::kGravity}, {"against", against}}), check_level(force),
          check_gyro(rate_moments(recording), force.deviation <= kImuStill.most)};
}

// Needs the results of check_imu_at_rest(): compares the attitude with the direction of gravity.
CheckResults check_mocap_at_rest(const VehicleRecording& recording, const CheckResults& imu) {
  const std::size_t frames = recording.mocap.samples.size();
  if (frames < kFewest) return {};
  const std::vector<plant::PoseSample> poses = tracked_poses(recording);
  CheckResults results = {
      judge(kMocapTracked, 1e2 * (1.0 - static_cast<double>(poses.size()) / static_cast<double>(frames)))};
  if (poses.size() < kFewest) return results;
  const Moments position =
      moments(poses.size(), [&](std::size_t i) -> Vector3d { return poses[i].position_ned; });
  results.push_back(judge(kMocapValues, repeated_percent(poses, repeats_pose)));
  results.push_back(judge(kMocapStill, 1e3 * position.deviation));
  results.push_back(passes(imu, kImuGravity.name) && passes(imu, kImuLevel.name)
                        ? check_mocap_gravity(poses, force_moments(recording).mean)
                        : skipped(kMocapGravity.name, recording.imu.samples.empty()
                                                          ? "the vehicle sends no imu"
                                                          : "the IMU does not show gravity as it should"));
  return results;
}

// True if it publishes vehicle_odometry, and no imu.
bool brings_odometry(const VehicleRecording& recording) {
  return !recording.imu.is_present() && recording.odometry.is_present();
}

// "Down" in body axes.
Vector3d down_frd(const Eigen::Quaterniond& q_ned_from_frd) {
  return q_ned_from_frd.conjugate() * Vector3d::UnitZ();
}

CheckResult check_against_mocap(const VehicleRecording& recording, const plant::OdometrySample& sample) {
  const std::optional<plant::PoseSample> pose = last_pose(recording);
  if (!pose) return skipped(kOdometryMocap.name, "no pose of motion capture");
  const double off_deg = angle_deg(down_frd(sample.q_ned_from_frd), down_frd(pose->q_ned_from_frd));
  return judge(kOdometryMocap, off_deg,
               {{"distance", (sample.position_ned - pose->position_ned).norm()},
                {"turn", math::kDegPerRad * sample.q_ned_from_frd.angularDistance(pose->q_ned_from_frd)}});
}

CheckResults check_odometry_at_rest(const VehicleRecording& recording) {
  const auto& samples = recording.odometry.samples;
  if (samples.size() < kFewest) return {};
  std::size_t whole = 0;
  double speed_m_s = 0.0;
  double rate_rad_s = 0.0;
  for (const auto& received : samples) {
    const plant::OdometrySample& sample = received.sample.odometry;
    whole += sample.position_valid && sample.velocity_valid ? 1 : 0;
    speed_m_s = std::max(speed_m_s, sample.velocity_ned.norm());
    rate_rad_s = std::max(rate_rad_s, sample.body_rates_frd.norm());
  }
  const plant::OdometrySample& last = samples.back().sample.odometry;
  const std::uint32_t resets = last.resets - samples.front().sample.odometry.resets;
  return {judge(kOdometryValid, 1e2 * (static_cast<double>(whole) / static_cast<double>(samples.size()))),
          judge(kOdometryLevel, angle_deg(down_frd(last.q_ned_from_frd), Vector3d::UnitZ())),
          judge(kOdometrySpeed, speed_m_s),
          judge(kOdometryRates, rate_rad_s),
          judge(kOdometryResets, resets),
          check_against_mocap(recording, last)};
}

std::string voltage_finding(double voltage_v, double full_v) {
  const double part = voltage_v / full_v;
  const auto is_voltage = [](double of_full) { return of_full >= kEmptiest && of_full <= kFullest; };
  if (is_voltage(part)) return "";
  if (is_voltage(1e-3 * part)) return "battery in mV: {against}";
  if (is_voltage(1e-2 * part)) return "battery in hundredths of a volt: {against}";
  if (voltage_v < 0.1) return "the battery's voltage is not measured: {against}";
  for (int cells = 2; cells <= 6; ++cells) {
    if (is_voltage(part * cells))
      return "voltage of one cell of " + std::to_string(cells) + ", or another battery: {against}";
    if (is_voltage(part / cells))
      return "another battery, of " + std::to_string(cells) + " times the cells: {against}";
  }
  return "the battery is empty, or its voltage is wrong: {against}";
}

// vehicle: null if its file is not known; the voltage must then be that of some battery.
CheckResults check_supply(const VehicleRecording& recording, const plant::Vehicle* vehicle) {
  const auto& samples = recording.battery.samples;
  if (samples.empty()) return {};
  double voltage_v = 0.0;
  for (const auto& received : samples)
    voltage_v += received.sample.voltage_v / static_cast<double>(samples.size());
  Words words = {{"charge", 1e2 * samples.back().sample.state_of_charge}};
  if (vehicle == nullptr) return {judge(kVoltage, voltage_v, words)};
  const double full_v = vehicle->battery.open_circuit_voltage_v.back();
  words.emplace_back("against",
                     fmt::format("voltage_v is {:.4g}, the vehicle file's battery has {:.2f} V when full",
                                 voltage_v, full_v));
  return {judge_by(with_limits(kVoltage, kEmptiest * full_v, kFullest * full_v), voltage_v,
                   voltage_finding(voltage_v, full_v), words)};
}

// Compares vehicle_info with the vehicle file.
CheckResults check_description(const VehicleRecording& recording, const plant::Vehicle& vehicle) {
  if (!recording.description) return {skipped("vehicle_info.received", "optional, and none arrived")};
  const VehicleDescription& info = *recording.description;
  const std::vector<double>& open_circuit_v = vehicle.battery.open_circuit_voltage_v;
  const Words words = {{"foreign", info.foreign},       {"name", info.name},
                       {"file", vehicle.name},          {"expected", vehicle.mass_kg},
                       {"full", open_circuit_v.back()}, {"empty", open_circuit_v.front()}};
  if (!info.foreign.empty())
    return {judge_by(kWireVersion, 0.0,
                     "{foreign}: vehicle_info.wire_version must be WIRE_VERSION of VehicleInfo", words)};
  const double rotors = vehicle.rotor_count();
  CheckResults results = {judge(with_limits(kRotorCount, rotors, rotors), info.rotor_count, words)};
  if (closes_inner_loops(info.levels) && !recording.rotors_running.empty()) {
    const bool running = recording.rotors_running.back().sample;
    results.push_back(judge(kRotorsRunning, running ? 1.0 : 0.0, {{"running", running ? "true" : "false"}}));
  }
  if (!info.name.empty() && info.name != vehicle.name)
    results.push_back(judge_by(
        kName, 0.0, "the vehicle is {name}, not {file} of the vehicle file: control does not arm it", words));
  const auto compare = [&](const Check& check, double reported, double expected) {
    if (reported > 0.0)
      results.push_back(
          judge(with_limits(check, check.least * expected, check.most * expected), reported, words));
  };
  compare(kMass, info.mass_kg, vehicle.mass_kg);
  compare(kFullBattery, info.full_battery_v, open_circuit_v.back());
  compare(kEmptyBattery, info.empty_battery_v, open_circuit_v.front());
  return results;
}

}  // namespace

Eigen::Vector3d mean_specific_force(const VehicleRecording& recording) {
  return force_moments(recording).mean;
}
Eigen::Vector3d mean_body_rates(const VehicleRecording& recording) { return rate_moments(recording).mean; }

CheckResults check_standing_vehicle(const VehicleRecording& recording, const plant::Vehicle* vehicle,
                                    bool mocap_required) {
  if (runs_in_lockstep(recording))
    return {
        missing("imu.lockstep", "the simulated vehicle runs in lockstep: start it in real time to check it")};
  const bool odometry = brings_odometry(recording);
  CheckResults results;
  for (const std::string& mismatch : recording.mismatches)
    results.push_back(judge_by(kEndpoint, 0.0, "{mismatch}", {{"mismatch", mismatch}}));
  append(results, odometry ? check_odometry_stream(recording) : check_imu_stream(recording));
  const CheckResults imu = odometry ? check_odometry_at_rest(recording) : check_imu_at_rest(recording);
  append(results, imu);
  append(results, check_stream(kBatteryStream, recording.battery, recording));
  append(results, check_supply(recording, vehicle));
  append(results, check_stream(kRotorSpeedStream, recording.rotor_speeds, recording));
  append(results,
         check_stream(mocap_required ? kRequiredMocapStream : kMocapStream, recording.mocap, recording));
  append(results, check_mocap_at_rest(recording, imu));
  if (vehicle != nullptr) append(results, check_description(recording, *vehicle));
  return results;
}

}  // namespace swiftlet::ground
