// A vehicle process with its microcontroller at the far end of a serial line or of UDP, as real processes: once in real time,
// which its clock and the times of the link need, otherwise in scaled time.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "swiftlet/record/evaluation.hpp"
#include "swiftlet/services/microcontroller/firmware.hpp"
#include "swiftlet/services/microcontroller/port.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "tests/support/hop_mission.hpp"
#include "tests/support/separate_processes.hpp"
#include "tests/support/serial_cable.hpp"

namespace swiftlet::tests {
namespace {

using ground::View;
namespace msg = ground::msg;
namespace topics = messages::topics;

// The part of a flight in which the reference flies the square, 1 m above the ground.
record::Window at_height(const record::Flight& flight) {
  record::Window window;
  for (const record::ReferenceRow& row : flight.reference) {
    if (row.position_ned[2] > -0.999) continue;
    if (window.from_ns == 0) window.from_ns = row.stamp_ns;
    window.to_ns = row.stamp_ns;
  }
  return window;
}

class VehicleTemplate : public SeparateProcesses {
 protected:
  // A busy machine may stop any process for a while, which must not end a flight: the microcontroller is patient.
  void start_microcontroller(std::vector<std::string> link, const std::string& speed = "3",
                             const std::string& patience_s = "0.5") {
    link.insert(link.end(), {"--clock-offset", "1000", "--clock-drift", "50", "--command-timeout", "0.5",
                             "--patience", patience_s, "--speed", speed});
    microcontroller_ = start("swiftlet-microcontroller", std::move(link));
  }
  void start_vehicle(const std::vector<std::string>& link) {
    plant_ = start("swiftlet-vehicle-template", link);
  }
  void start_others() {
    control_ = start("swiftlet-control");
    mocap_ = start("swiftlet-mocap");
  }
  void start_over_cable(const std::string& speed = "3", const std::string& patience_s = "0.5") {
    start_microcontroller({"--pty", far_tty_}, speed, patience_s);
    cable_ = std::make_unique<SerialCable>(far_tty_, tty_);
    start_vehicle({"--device", tty_});
    start_others();
    wait_until_ready();
  }

  bool has_fault(const std::string& part) const {
    return client_->wait(kTimeout, [&](const View& view) {
      const std::string fault = view.vehicle.message.fault().c_str();
      return part.empty() ? fault.empty() : fault.find(part) != std::string::npos;
    });
  }
  bool logged(const Program& program, const std::string& text) const {
    const bool found = eventually([&] { return program.errors().find(text) != std::string::npos; }, kTimeout);
    EXPECT_TRUE(found) << "not found: " << text << "\n" << program.errors();
    return found;
  }
  std::string end(Program& program) const {
    program.signal(SIGTERM);
    EXPECT_EQ(program.wait(kTimeout), 0) << program.errors();
    return program.errors();
  }

  const std::string far_tty_ = folder_.path() / "microcontroller.tty";
  const std::string tty_ = folder_.path() / "vehicle.tty";
  std::unique_ptr<Program> microcontroller_;
  std::unique_ptr<SerialCable> cable_;
};

class VehicleTemplateInRealTime : public VehicleTemplate {
 protected:
  // The clock of the vehicle is the microcontroller's, 1000 s ahead and 50 ppm fast, and the process answers for it.
  void expect_clock_of_microcontroller() {
    std::atomic<std::int64_t> received_ns{0};
    auto requests = watcher_->publish(topics::kClockRequest);
    const auto replies = watcher_->subscribe<msg::ClockReply>(
        topics::kClockReply, [&](const msg::ClockReply& reply) { received_ns = reply.received_ns(); });
    std::int64_t before_ns = 0;
    ASSERT_TRUE(eventually([&] {
      if (!client_->view().truth.seen()) return false;
      before_ns = stamp_ns();
      msg::ClockRequest request;
      request.client(1);
      request.sequence_number(1);
      requests.publish(request);
      return eventually([&] { return received_ns != 0; }, std::chrono::milliseconds(50));
    })) << plant_->errors();
    const std::int64_t reply_ns = received_ns;
    EXPECT_GT(reply_ns, 1'000'000'000'000);
    EXPECT_TRUE(wait_for_truth([&](const auto& truth) { return truth.stamp_ns() >= reply_ns; }))
        << "not of the future";
    constexpr std::int64_t kSlackNs = 100'000'000;  // a busy machine delays the truth, and the exchanges
    EXPECT_GE(reply_ns, before_ns - kSlackNs);
  }
};

TEST_F(VehicleTemplateInRealTime, FliesTheSquareThroughAPseudoTerminal) {
  start_microcontroller({"--pty", tty_}, "1");
  start_vehicle({"--device", tty_});
  expect_clock_of_microcontroller();
  start_others();
  wait_until_ready();
  ground::Result armed;
  ASSERT_TRUE(eventually([&] { return (armed = ask(control::RequestKind::kArm)).accepted(); }, kTimeout))
      << armed.reason;
  const ProgramResult fly = run_program(
      "swiftlet",
      {"fly", folder_.write("square.yaml", kSmallSquareMission), "--attach", "--skip-check", "--record",
       folder_.path() / "record", "--localhost-only", "--domain", std::to_string(lock_.domain())},
      folder_.path(), kTimeout);
  ASSERT_EQ(fly.exit_code, 0) << fly.errors << plant_->errors() << microcontroller_->errors();
  const record::Flight flight = telemetry_->flight();
  const auto errors = record::tracking_errors(flight.truth, flight.reference, at_height(flight));
  EXPECT_LT(errors.rms_3d_m, 0.005);
  EXPECT_GT(errors.matched, 1000U) << "of about 1500";
  const msg::VehicleInfo info = client_->view().vehicle.message;
  EXPECT_TRUE(info.simulated()) << "as the microcontroller says";
  EXPECT_EQ(info.imu_rate_hz(), 500.0);
  EXPECT_GT(info.answered(), 1000U);
  EXPECT_GT(info.sense_to_actuate_p50_us(), 0.0);
  const std::string log = end(*plant_);
  for (const char* part : {"session 1 with microcontroller 'swiftlet simulated': protocol 1, 4 rotors",
                           "link: sample to host p50 ", "; sample to motor p50 ", " samples answered"})
    EXPECT_NE(log.find(part), std::string::npos) << part << "\n" << log;
}

TEST_F(VehicleTemplate, FliesOverUdp) {
  const std::string address = "127.0.0.1:" + std::to_string(29'000 + lock_.domain());
  start_microcontroller({"--udp", address});
  start_vehicle({"--udp", address});
  start_others();
  hover();
}

TEST_F(VehicleTemplate, FliesWithBytesLostAndChangedBothWays) {
  start_over_cable("1", "0.02");  // it waits so long for each answer that is lost
  hover();
  cable_->loss = 1e-4;
  cable_->errors = 1e-4;  // of the 60 bytes of a frame
  clear_history();
  wait_vehicle_time(3.0);
  EXPECT_EQ(mode_log(), "holding: take-off completed\n");
  EXPECT_LT(distance_m(0, 0, -1), 0.05);
  cable_->loss = cable_->errors = 0.0;
  const std::string log = end(*plant_);
  EXPECT_NE(log.find("frames from the microcontroller: "), std::string::npos) << log;
  EXPECT_EQ(log.find(" 0 broken", log.find("ended: ")), std::string::npos) << "counted both ways\n" << log;
}

// A microcontroller that gets its power from the cable: its clock starts again.
TEST_F(VehicleTemplate, HealsWhenTheMicrocontrollerRestartsOnTheGround) {
  start_microcontroller({"--pty", tty_});
  start_vehicle({"--device", tty_});
  start_others();
  wait_until_ready();
  wait_vehicle_time(2.0);
  microcontroller_->signal(SIGKILL);
  microcontroller_->wait(kTimeout);
  EXPECT_TRUE(has_fault("no link to the microcontroller: "));
  start_microcontroller({"--pty", tty_});
  EXPECT_TRUE(has_fault(""));
  hover();
}

TEST_F(VehicleTemplate, HealsWhenItIsUnpluggedOnTheGroundAndInFlightTheMicrocontrollerStopsTheRotors) {
  start_over_cable();
  cable_->unplug();
  EXPECT_TRUE(has_fault("no link to the microcontroller: " + tty_ + ": "));
  EXPECT_TRUE(eventually([&] { return client_->view().control.message.imu_age_s() > 0.5; }, kTimeout));
  cable_->plug();
  EXPECT_TRUE(has_fault(""));
  EXPECT_TRUE(logged(*plant_, "session 2 with microcontroller"));
  hover();

  cable_->unplug();
  EXPECT_TRUE(logged(*microcontroller_, "rotors stopped: no command within the time-out"));
  EXPECT_TRUE(wait_until_on_ground());
  cable_->plug();
  EXPECT_TRUE(logged(*plant_, "session 3 with microcontroller"));
  clear_history();
  wait_vehicle_time(1.0);
  EXPECT_LT(fastest_rotor(truth().back()), 1.0) << "rad/s";
  EXPECT_EQ(
      microcontroller_->errors().find("rotors started", microcontroller_->errors().find("rotors stopped")),
      std::string::npos);
  EXPECT_TRUE(has_fault("no command within the time-out"));
}

// A microcontroller that the vehicle process cannot fly: both ends stay apart, and the process says why.
TEST_F(VehicleTemplate, RefusesAnotherVersionAndAnotherVehicleByName) {
  const auto port = services::open_pseudo_terminal(tty_);
  const auto refusal_of = [&](services::FirmwareSettings settings) {
    settings.name = "bench board";
    services::Firmware firmware(
        settings, [&](const std::uint8_t* bytes, std::size_t size) { port->write(bytes, size); });
    const auto vehicle = start("swiftlet-vehicle-template", {"--device", tty_});
    EXPECT_TRUE(eventually([&] {
      std::uint8_t bytes[256];
      while (const std::size_t count = port->read(bytes, sizeof bytes))
        firmware.take(bytes, count, runtime::monotonic_ns() / 1000);
      return vehicle->exit_code().has_value();
    }));
    EXPECT_EQ(vehicle->exit_code(), 1);
    return vehicle->errors();
  };
  services::FirmwareSettings version;
  version.version = 2;
  const std::string of_version = refusal_of(version);
  EXPECT_NE(of_version.find("microcontroller 'bench board' at " + tty_ +
                            " speaks version 2 of the protocol, must be version 1"),
            std::string::npos)
      << of_version;
  services::FirmwareSettings rotors;
  rotors.rotor_count = 6;
  const std::string of_rotors = refusal_of(rotors);
  EXPECT_NE(of_rotors.find(" has 6 rotors, must be the 4 of vehicle "), std::string::npos) << of_rotors;
}

TEST_F(VehicleTemplate, RefusesWrongUsage) {
  const auto refusal = [&](const std::string& program, std::vector<std::string> words) {
    const ProgramResult result = run_program(program, std::move(words), folder_.path());
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    return result.errors;
  };
  EXPECT_NE(refusal("swiftlet-vehicle-template", {}).find("give either --device or --udp"),
            std::string::npos);
  EXPECT_NE(refusal("swiftlet-vehicle-template", {"--device", "/dev/x", "--baud", "1"})
                .find("--baud: is 1, must be one of 57600, 115200, "),
            std::string::npos);
  EXPECT_NE(refusal("swiftlet-microcontroller", {}).find("give --pty PATH or --udp HOST:PORT"),
            std::string::npos);
  EXPECT_NE(
      refusal("swiftlet-microcontroller", {"--pty", folder_.write("file", "")}).find("must be a new name"),
      std::string::npos);
}

}  // namespace
}  // namespace swiftlet::tests
