// A vehicle, motion capture and control service as separate processes, on a domain of their own, and the
// ground's end of the wire in the test. Each may be started, stopped and killed by itself.
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
#include "tests/integration/program.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {

class SeparateProcesses : public testing::Test {
 protected:
  static constexpr std::chrono::seconds kTimeout{30};

  SeparateProcesses();

  comms::NodeSettings node(const std::string& name) const;
  // The program's arguments, and what puts it on this domain.
  std::unique_ptr<Program> start(const std::string& program, std::vector<std::string> arguments = {}) const;
  void start_all(const std::vector<std::string>& control_arguments = {},
                 const std::vector<std::string>& plant_arguments = {});
  // Until `control` has a pose and the vehicle's truth is heard.
  void wait_until_ready();
  void hover();

  ground::Result ask(std::uint8_t kind, double z_ned = -1.0);
  // Until some control_status since the last call of forget() says so.
  bool reported(control::Mode mode, const std::string& reason, std::chrono::milliseconds timeout = kTimeout);
  void forget();
  // The modes and reasons that were told, one a line.
  std::string story() const;

  // The truth since the last call of forget().
  std::vector<ground::TruthRow> truth() const {
    return {record_.truth.begin() + forgotten_, record_.truth.end()};
  }
  std::int64_t stamp_ns() const { return client_->view().truth.message.stamp_ns(); }
  bool wait_for_truth(const std::function<bool(const ground::msg::GroundTruth&)>& predicate,
                      std::chrono::milliseconds timeout = kTimeout) const;
  // So long by the vehicle's clock.
  void fly_on(double seconds) const;
  bool wait_until_rotors_off() const;
  bool wait_until_on_ground() const;
  double distance_m(double x, double y, double z) const;

  comms::DomainLock lock_;
  TemporaryFolder folder_;
  std::unique_ptr<Program> plant_, mocap_, control_;
  ground::FlightRecord record_;
  std::size_t forgotten_ = 0;  // rows of truth
  std::unique_ptr<ground::Client> client_;
  std::unique_ptr<comms::Node> watcher_;
  Inbox<std::string> story_;
  comms::Subscription status_;
};

// Of a row of truth.
double tilt_rad(const ground::TruthRow& row);
double fastest_rotor(const ground::TruthRow& row);

}  // namespace swiftlet::tests
