// Events of a client about its connection to the control process.
#include "swiftlet/ground/client/connection_watch.hpp"

#include <gtest/gtest.h>

namespace swiftlet::ground::connection_watch_test {

using Kind = ConnectionEvent::Kind;
using namespace std::chrono_literals;

class ConnectionWatchTest : public testing::Test {
 protected:
  void receive_status(std::uint64_t controller) {
    view_.control.message.controller(controller);
    view_.control.message.reason() = "started";
    view_.control.received = now_;
    ++view_.control.count;
  }
  std::optional<ConnectionEvent> look_after(std::chrono::milliseconds time) {
    now_ += time;
    return watch_.update(view_, now_);
  }

  View view_;
  Clock::time_point now_{1h};
  ConnectionWatch watch_;
};

TEST_F(ConnectionWatchTest, ReportsConnectionLossAndReconnection) {
  EXPECT_FALSE(look_after(5s)) << "never connected";
  EXPECT_FALSE(is_connected(view_, now_));
  receive_status(7);
  const auto connected = look_after(10ms);
  ASSERT_TRUE(connected);
  EXPECT_EQ(connected->kind, Kind::kConnected);
  EXPECT_EQ(connected->controller, 7U);
  EXPECT_EQ(connected->text, "control process connected: disarmed (started)");
  EXPECT_FALSE(look_after(900ms));
  EXPECT_TRUE(is_connected(view_, now_));
  const auto lost = look_after(200ms);
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->kind, Kind::kLost);
  EXPECT_EQ(lost->controller, 7U);
  EXPECT_FALSE(look_after(5s));
  receive_status(7);
  const auto reconnected = look_after(10ms);
  ASSERT_TRUE(reconnected);
  EXPECT_EQ(reconnected->kind, Kind::kConnected);
  EXPECT_EQ(reconnected->text, "control process connected again: disarmed (started)");
}

TEST_F(ConnectionWatchTest, ReportsAReplacedControllerWithAndWithoutTimeout) {
  receive_status(7);
  ASSERT_TRUE(look_after(0ms));
  receive_status(8);
  const auto replaced = look_after(100ms);
  ASSERT_TRUE(replaced);
  EXPECT_EQ(replaced->kind, Kind::kReplaced);
  EXPECT_EQ(replaced->controller, 8U);
  EXPECT_EQ(replaced->text, "another control process controls the vehicle: disarmed (started)");
  EXPECT_FALSE(look_after(100ms));
  EXPECT_EQ(look_after(2s)->kind, Kind::kLost);
  receive_status(9);
  EXPECT_EQ(look_after(0ms)->kind, Kind::kReplaced);
}

}  // namespace swiftlet::ground::connection_watch_test
