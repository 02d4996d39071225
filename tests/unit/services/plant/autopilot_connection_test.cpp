#include "swiftlet/services/plant/autopilot_connection.hpp"

#include <array>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <unistd.h>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/scripted_autopilot.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::services::autopilot_connection_test {

using tests::kStuck;

class AutopilotConnectionTest : public testing::Test {
 protected:
  tests::ScriptedAutopilot autopilot() const { return {vehicle_, plant::SiteSettings(), {}}; }
  template <class Predicate>
  bool receives_until(AutopilotConnection& connection, Predicate predicate) {
    std::array<std::uint8_t, 256> bytes{};
    return tests::eventually([&] {
      connection.receive(0, bytes.data(), bytes.size());
      return predicate();
    });
  }

  const plant::Vehicle vehicle_ = io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"));
};

TEST_F(AutopilotConnectionTest, RefusesASecondAutopilotAndKeepsTheFirst) {
  AutopilotSettings settings;
  settings.port = tests::free_tcp_port();
  AutopilotConnection connection(settings);
  tests::ScriptedAutopilot first = autopilot();
  ASSERT_TRUE(first.connect(settings.port, kStuck));
  ASSERT_TRUE(receives_until(connection, [&] { return connection.connected(); }));
  tests::ScriptedAutopilot second = autopilot();
  ASSERT_TRUE(second.connect(settings.port, kStuck));
  for (int i = 0; i < 10; ++i) receives_until(connection, [] { return true; });
  EXPECT_FALSE(second.fly_until(1.0, kStuck)) << "its connection ends";
  EXPECT_TRUE(connection.connected());
  EXPECT_EQ(connection.connections(), 1U);
}

// GIVEN an autopilot that has ended, WHEN the next one connects before this was noticed, THEN it is not taken for a second one.
TEST_F(AutopilotConnectionTest, TakesTheNextAutopilotWhenTheFirstHasEnded) {
  AutopilotSettings settings;
  settings.port = tests::free_tcp_port();
  AutopilotConnection connection(settings);
  tests::ScriptedAutopilot first = autopilot();
  ASSERT_TRUE(first.connect(settings.port, kStuck));
  ASSERT_TRUE(receives_until(connection, [&] { return connection.connected(); }));
  std::array<std::uint8_t, 256> introduction{};
  connection.receive(0, introduction.data(), introduction.size());
  first.disconnect();
  tests::ScriptedAutopilot second = autopilot();
  ASSERT_TRUE(second.connect(settings.port, kStuck));
  EXPECT_TRUE(receives_until(connection, [&] { return connection.connections() == 2; }));
  EXPECT_TRUE(connection.connected());
}

TEST_F(AutopilotConnectionTest, OpensASerialDeviceAgainThatWasUnplugged) {
  const tests::TemporaryFolder folder;
  const std::filesystem::path device = folder.path() / "tty";
  const auto plug = [&] {
    const int board = ::posix_openpt(O_RDWR | O_NOCTTY);
    EXPECT_TRUE(::grantpt(board) == 0 && ::unlockpt(board) == 0);
    std::filesystem::create_symlink(::ptsname(board), device);
    return board;
  };
  AutopilotSettings settings;
  settings.device = device;
  EXPECT_THROW(AutopilotConnection{settings}, std::runtime_error);
  int board = plug();
  AutopilotConnection connection(settings);
  EXPECT_TRUE(connection.connected());
  EXPECT_THROW(AutopilotConnection{settings}, std::runtime_error) << "a second process on the line";
  ::close(board);
  std::filesystem::remove(device);
  EXPECT_TRUE(receives_until(connection, [&] { return !connection.connected(); }));
  board = plug();
  EXPECT_TRUE(receives_until(connection, [&] { return connection.connected(); }));
  EXPECT_EQ(connection.connections(), 2U);
  ::close(board);
}

}  // namespace swiftlet::services::autopilot_connection_test
