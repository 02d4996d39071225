// DDS Security: the roles fly together, and others neither hear nor change anything.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/network_key.hpp"
#include "swiftlet/io/security/certificates.hpp"
#include "swiftlet/io/security/security_folder.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/messages/security_policy.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/program.hpp"
#include "tests/support/redundant_flight.hpp"
#include "tests/support/shifted_clock.hpp"
#include "tests/support/simulated_time.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;
namespace msg = messages::msg;
using namespace std::chrono_literals;

constexpr std::int64_t kDays_s = 24 * 3600;

class Security : public testing::Test {
 protected:
  ProgramResult swiftlet(std::vector<std::string> words) const {
    return run_program("swiftlet", std::move(words), folder_.path());
  }
  std::string keys(const std::string& name) const {
    const std::string path = folder_.path() / name;
    if (!fs::exists(path)) {
      const ProgramResult made = swiftlet({"keys", "create", path, "--vehicle", "kl1"});
      if (made.exit_code != 0) throw std::runtime_error(made.errors);
    }
    return path;
  }
  static dds::NodeSettings secured(const std::string& security) {
    dds::NodeSettings settings;
    settings.security = security;
    return settings;
  }

  // A copy of the folder for a process that does not check what its role may write, as one that an attacker has changed.
  std::string without_write_control(const std::string& keys) const {
    const std::string path = folder_.path() / "captured";
    fs::copy(keys, path, fs::copy_options::recursive);
    const io::SecurityFolder copy{path};
    const io::Credential authority{io::read_text_file(copy.authority()),
                                   io::read_text_file(copy.authority_key())};
    const std::string on = "<enable_write_access_control>true<";
    std::string governance = messages::governance_document();
    governance.replace(governance.find(on), on.size(), "<enable_write_access_control>false<");
    std::ofstream(copy.governance()) << io::sign(authority, governance);
    return path;
  }

  // Sends commands that stop the rotors to the vehicle, which flies.
  static void expect_not_obeyed(const RedundantFlight& flight, dds::Node& sender) {
    dds::Publisher<msg::ActuatorCommand> commands = sender.publish(messages::topics::kActuatorCommand);
    msg::ActuatorCommand stop;
    stop.rotor_state(msg::ActuatorCommand_Constants::ROTORS_OFF);
    stop.rotor_count(4);
    stop.term(0xfffffff0U);
    const std::int64_t from_ns = flight.stamp_ns();
    flight.wait("a second in which somebody else sends commands", [&] {
      stop.stamp_ns(flight.stamp_ns());
      commands.publish(stop);
      return flight.stamp_ns() > from_ns + kSecond;
    });
    EXPECT_EQ(commands.matched(), 0);
    EXPECT_LT(flight.z_ned(), -0.98) << "the vehicle obeyed";
  }
  static bool says(const Program& program, const std::string& text) {
    return program.errors().find(text) != std::string::npos;
  }
  // reason: as Fast DDS has it.
  static bool refuses(const Program& program, const std::string& reason) {
    return says(program, "refused 'ground' (") && says(program, "): see the log of Fast DDS") &&
           says(program, reason);
  }
  static bool is_refused_by(const Program& program, const std::string& reason) {
    return eventually([&] { return refuses(program, reason); }, kStuck, 20ms);
  }

  TemporaryFolder folder_;
};

TEST_F(Security, StandbyTakesOverAndNeitherStrangersNorGroundFlyTheVehicle) {
  RedundantFlight flight(folder_.path(), plant_in_simulated_time(), secured(keys("lab")),
                         mocap_in_simulated_time());
  flight.start_controller(5);
  flight.start_controller(1);
  flight.wait_for_roles(1, 1);
  flight.fly(square_laps(0.5, 50));
  flight.wait("the vehicle flies a side", [&] { return flight.z_ned() < -0.98 && flight.speed() > 0.3; });

  dds::NodeSettings open = flight.node_settings("stranger");
  open.security.clear();
  dds::Node stranger(open);
  expect_not_obeyed(flight, stranger);

  dds::Node ground(flight.node_settings("ground"));
  EXPECT_THROW(ground.publish(messages::topics::kActuatorCommand), std::runtime_error);
  dds::NodeSettings captured = flight.node_settings("ground");
  captured.security = without_write_control(keys("lab"));
  dds::Node captured_ground(captured);
  expect_not_obeyed(flight, captured_ground);

  for (int kill = 0; kill < 2; ++kill) {
    const std::int64_t at_ns = flight.stamp_ns();
    flight.kill(flight.active());
    const FlightMetrics metrics = flight.metrics(at_ns, at_ns + kSecond);
    EXPECT_LT(metrics.longest_gap_ms, kLongestGap_ms);
    EXPECT_GT(metrics.longest_gap_ms, 10.0) << "the gap must show the kill";
    EXPECT_LT(metrics.largest_deviation_m, kLargestDeviation_m);
    EXPECT_EQ(metrics.changes_of_controller, 1);
    if (kill > 0) break;
    flight.start_controller(kill);
    flight.wait_for_roles(1, 1);
  }
}

TEST_F(Security, StrangersAreRefusedByName) {
  const std::string lab = [&] {
    const ShiftedClock early(folder_.path() / "shift",
                             {-3 * kDays_s});  // so that a certificate can have expired
    return keys("lab");
  }();
  RedundantFlight flight(folder_.path(), plant_in_simulated_time(), secured(lab), mocap_in_simulated_time());
  const Program& control = *flight.start_controller(5).process;
  flight.wait_for_roles(1, 0);
  std::vector<std::string> network = flight.network();
  network.resize(network.size() - 2);  // without --security
  const auto status = [&](const std::vector<std::string>& options, const std::string& timeout_s = "3") {
    std::vector<std::string> words{"status", "--timeout", timeout_s};
    words.insert(words.end(), network.begin(), network.end());
    words.insert(words.end(), options.begin(), options.end());
    return std::make_unique<Program>("swiftlet", words, folder_.path());
  };

  // Who was revoked after it got its copy of the list.
  const std::string thief = folder_.path() / "thief";
  fs::copy(lab, thief, fs::copy_options::recursive);
  ASSERT_EQ(swiftlet({"keys", "renew", thief, "ground"}).exit_code, 0);
  io::revoke_identity({lab}, io::SecurityFolder{thief}.certificate("ground"));
  const std::string foreign = keys("foreign");
  const std::string patient = "25";  // a busy machine takes long for a handshake
  const auto own = status({"--security", lab}, patient);
  const auto without_identity = status({});
  const auto stranger = status({"--security", foreign});
  // Whose clock is three days late.
  const std::string old = folder_.path() / "old";
  fs::copy(thief, old, fs::copy_options::recursive);
  std::unique_ptr<Program> expired;
  {
    const ShiftedClock late(folder_.path() / "shift", {-3 * kDays_s});
    ASSERT_EQ(swiftlet({"keys", "renew", old, "ground", "--days", "1"}).exit_code, 0);
    expired = status({"--security", old});
  }
  EXPECT_EQ(own->wait(kStuck), 0) << own->errors();
  EXPECT_EQ(without_identity->wait(kStuck), 1);
  EXPECT_TRUE(is_refused_by(control, "")) << control.errors();
  EXPECT_EQ(stranger->wait(kStuck), 1);
  // Either side may be the first to see a foreign certificate.
  EXPECT_TRUE(refuses(control, "certificate signature failure") || says(*stranger, "refused 'control' ("))
      << control.errors() << stranger->errors();
  EXPECT_EQ(expired->wait(kStuck), 1);
  EXPECT_TRUE(is_refused_by(control, "certificate has expired")) << control.errors();

  const Program& wary = *flight.start_controller(1).process;
  const auto revoked = status({"--security", thief}, patient);
  EXPECT_EQ(revoked->wait(kStuck), 0) << "the first controller has the old list";
  EXPECT_TRUE(is_refused_by(wary, "certificate revoked")) << wary.errors();
}

TEST_F(Security, OwnFaultsAreToldBeforeJoining) {
  const std::string lab = keys("lab");
  const ProgramResult missing = swiftlet({"status", "--security", folder_.path() / "none"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.errors.find("none/observer/certificate.pem: cannot be read"), std::string::npos)
      << missing.errors;
  ASSERT_EQ(swiftlet({"keys", "revoke", lab, "ground"}).exit_code, 0);
  const ProgramResult revoked = swiftlet({"status", "--security", lab});
  EXPECT_EQ(revoked.exit_code, 2);
  EXPECT_NE(revoked.errors.find("lab/ground/certificate.pem is revoked"), std::string::npos)
      << revoked.errors;
  EXPECT_EQ(swiftlet({"keys", "create", lab, "--vehicle", "kl1"}).exit_code, 2) << "it exists";
}

TEST_F(Security, TheNetworkKeyIsExchangedInThreeSteps) {
  const std::string file = folder_.path() / "lab.key";
  const auto exchange = [&](const char* step) {
    return swiftlet({"keys", "network", file, "--exchange", step}).exit_code;
  };
  ASSERT_EQ(swiftlet({"keys", "network", file}).exit_code, 0);
  EXPECT_EQ(swiftlet({"keys", "network", file}).exit_code, 2) << "it exists";
  const io::NetworkKeys before = io::read_network_keys(file);
  ASSERT_EQ(before.size(), 1U);
  EXPECT_EQ(exchange("switch"), 2) << "there is one key";
  EXPECT_EQ(exchange("add"), 0);
  const io::NetworkKeys both = io::read_network_keys(file);
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[0], before[0]) << "the old one still sends";
  EXPECT_NE(both[1], before[0]);
  EXPECT_EQ(exchange("add"), 2) << "there are two";
  EXPECT_EQ(exchange("switch"), 0);
  EXPECT_EQ(io::read_network_keys(file), (io::NetworkKeys{both[1], both[0]}));
  EXPECT_EQ(exchange("drop"), 0);
  EXPECT_EQ(io::read_network_keys(file), io::NetworkKeys{both[1]});
}

TEST_F(Security, WholeFlightIsFlown) {
  const std::string mission =
      folder_.write("hop.yaml",
                    "name: hop\nframe: ned\ntolerance_m: 0.1\nitems:\n"
                    "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.5}\n"
                    "  - {kind: waypoint, position_m: [0.3, 0, -0.5], speed_m_s: 0.5}\n"
                    "  - {kind: land, speed_m_s: 0.5}\n");
  const dds::DomainLock lock;
  const ProgramResult flight = swiftlet({"fly", mission, "--clock", "lockstep", "--security", keys("lab"),
                                         "--domain", std::to_string(lock.domain())});
  EXPECT_EQ(flight.exit_code, 0) << flight.output << flight.errors;
}

}  // namespace
}  // namespace swiftlet::tests
