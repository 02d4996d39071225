// The server of the live page beside real flights.
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/services/dds/payload.hpp"
#include "tests/support/foxglove_client.hpp"
#include "tests/support/online_flight.hpp"

namespace swiftlet::tests {
namespace {

namespace msg = messages::msg;

// The port in the first URL of a text; 0 if there is none yet.
int port_in(const std::string& text) {
  std::smatch found;
  return std::regex_search(text, found, std::regex("http://127\\.0\\.0\\.1:(\\d+)/\\s")) ? std::stoi(found[1])
                                                                                         : 0;
}

std::unique_ptr<FoxgloveClient> viewer_at(int port) {
  auto viewer = std::make_unique<FoxgloveClient>(static_cast<std::uint16_t>(port));
  EXPECT_TRUE(viewer->open("localhost:" + std::to_string(port)));
  viewer->greet();
  return viewer;
}

// Reads messages of the only subscription until one is as wanted.
template <class T, class Predicate>
bool reads(FoxgloveClient& viewer, const Predicate& wanted) {
  while (const auto message = viewer.read_message()) {
    T read;
    EXPECT_TRUE(dds::from_payload(message->payload.data(), message->payload.size(), read));
    if (wanted(read)) return true;
  }
  return false;
}

// GIVEN a hovering vehicle WHEN a viewer lands it THEN it is answered, and sees it landing and disarmed.
TEST_F(OnlineFlight, ALiveViewerLandsTheVehicle) {
  Program server("swiftlet",
                 {"view", "--domain", std::to_string(lock_.domain()), "--localhost-only", "--port", "0"},
                 folder_.path());
  ASSERT_TRUE(eventually([&] { return port_in(server.output()) != 0; })) << server.errors();
  take_off();
  const auto viewer = viewer_at(port_in(server.output()));
  viewer->subscribe(1, viewer->channel("/kl7/control_status"));
  const auto in_mode = [&](std::uint8_t mode) {
    return reads<msg::ControlStatus>(
        *viewer, [mode](const msg::ControlStatus& status) { return status.mode() == mode; });
  };
  ASSERT_TRUE(in_mode(msg::ControlStatus_Constants::MODE_HOLDING));
  viewer->call(viewer->service("/kl7/land"), {0, 1, 0, 0});
  EXPECT_EQ(viewer->read_answer(), std::make_pair(true, std::string()));
  EXPECT_TRUE(in_mode(msg::ControlStatus_Constants::MODE_LANDING));
  EXPECT_TRUE(in_mode(msg::ControlStatus_Constants::MODE_DISARMED));
  viewer->call(viewer->service("/kl7/hold"), {0, 1, 0, 0});
  const auto refused = viewer->read_answer();
  EXPECT_FALSE(refused.first);
  EXPECT_NE(refused.second, "");
  server.signal(SIGINT);
  EXPECT_EQ(server.wait(kStuck), 0) << server.errors();
}

// GIVEN a flight with --view WHEN a viewer comes, goes and comes again THEN it sees the flight each time, and the flight
// completes and ends the server.
TEST(View, BesideAFlight) {
  const TemporaryFolder folder;
  const std::string mission = folder.write("hover.yaml",
                                           "frame: ned\ntolerance_m: 0.1\nitems:\n"
                                           "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.5, hold_s: 15}\n"
                                           "  - {kind: land, speed_m_s: 0.5}\n");
  Program flight("swiftlet",
                 {"fly", mission, "--view", "--clock", "lockstep", "--speed", "5", "--json", "--record",
                  folder.path() / "record"},
                 folder.path());
  ASSERT_TRUE(eventually([&] { return port_in(flight.errors()) != 0; })) << flight.errors();
  const int port = port_in(flight.errors());
  for (const double height_m : {0.1, 0.4}) {
    const auto viewer = viewer_at(port);
    viewer->subscribe(1, viewer->channel("/kl1/estimate"));
    EXPECT_TRUE(reads<msg::Estimate>(*viewer, [height_m](const msg::Estimate& estimate) {
      return estimate.position_ned()[2] < -height_m;
    }));
  }
  const auto viewer = viewer_at(port);
  viewer->subscribe(1, viewer->channel("/kl1/mission_status"));
  EXPECT_TRUE(reads<msg::MissionStatus>(*viewer, [](const msg::MissionStatus& status) {
    return status.state() == msg::MissionStatus_Constants::COMPLETED;
  }));
  EXPECT_EQ(flight.wait(kStuck), 0) << flight.errors();
  EXPECT_FALSE(viewer->read_message().has_value()) << "the server has ended";
  EXPECT_LT(json::parse(flight.output()).at("rms_3d_m"), 0.02);
}

TEST(View, RefusesBadInputInOneSentence) {
  const TemporaryFolder folder;
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"view", "--listen", "localhost"},
                                             {"view", "--listen", "300.0.0.1"},
                                             {"view", "--port", "65536"},
                                             {"view", "kl1"}}) {
    const ProgramResult result = run_program("swiftlet", words, folder.path());
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_EQ(result.output, "");
  }
}

}  // namespace
}  // namespace swiftlet::tests
