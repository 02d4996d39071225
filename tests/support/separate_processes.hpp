// Plant, motion capture and control service as separate processes on their own DDS domain, with a ground
// client in the test. Each process can be started, suspended and killed separately. Their time is simulated time
// (simulated_time.hpp) unless a test says otherwise.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/program.hpp"
#include "tests/support/simulated_time.hpp"
#include "tests/support/telemetry_log.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {

class SeparateProcesses : public testing::Test {
 protected:
  static constexpr std::chrono::seconds kTimeout = kStuck;

  SeparateProcesses();

  dds::NodeSettings node(const std::string& name) const;
  // Starts a program on this domain.
  std::unique_ptr<Program> start(const std::string& program, std::vector<std::string> arguments = {}) const;
  // In simulated time.
  void start_all(const std::vector<std::string>& control_arguments = {},
                 const std::vector<std::string>& plant_arguments = {}, const std::string& speed = kSpeed);
  // By the wall clock.
  void start_all_in_real_time();
  // Waits until control has a pose and ground truth and battery arrive.
  void wait_until_ready();
  void hover();

  ground::Result ask(control::RequestKind kind, double z_ned = -1.0);
  // Waits for a control_status with this mode and reason since the last clear_history().
  bool reported(control::Mode mode, const std::string& reason, std::chrono::milliseconds timeout = kTimeout);
  void clear_history();
  // The modes and reasons of control_status, one per line.
  std::string mode_log() const;

  // The truth since the last clear_history().
  std::vector<record::TruthRow> truth() const { return telemetry_->flight().truth; }
  std::int64_t stamp_ns() const { return client_->view().truth.message.stamp_ns(); }
  bool wait_for_truth(const std::function<bool(const ground::msg::GroundTruth&)>& predicate,
                      std::chrono::milliseconds timeout = kTimeout) const;
  // Waits for this time by the vehicle's clock.
  void wait_vehicle_time(double seconds) const;
  bool wait_until_rotors_off() const;
  bool wait_until_on_ground() const;
  double distance_m(double x, double y, double z) const;

  dds::DomainLock lock_;
  TemporaryFolder folder_;
  std::unique_ptr<Program> plant_, mocap_, control_;
  std::shared_ptr<ground::Client> client_;
  std::unique_ptr<dds::Node> watcher_;
  std::unique_ptr<TelemetryLog> telemetry_;  // since the last clear_history()
  Inbox<std::string> mode_log_;
  dds::Subscription status_;
};

// Tilt and fastest rotor, 1/s, in one row of ground truth.
double tilt_rad(const record::TruthRow& row);
double fastest_rotor(const record::TruthRow& row);

}  // namespace swiftlet::tests
