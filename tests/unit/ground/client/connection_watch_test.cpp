// What a client says of the control process that it hears, or hears no more.
#include "swiftlet/ground/client/connection_watch.hpp"

#include <gtest/gtest.h>

namespace swiftlet::ground {
namespace {

using Kind = ConnectionEvent::Kind;
using namespace std::chrono_literals;

class Connection : public testing::Test {
 protected:
  void hear(std::uint64_t controller) {
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

TEST_F(Connection, IsToldWhenItComesGoesAndComesBack) {
  EXPECT_FALSE(look_after(5s)) << "nothing was there, and nothing is";
  EXPECT_FALSE(is_connected(view_, now_));
  hear(7);
  const auto come = look_after(10ms);
  ASSERT_TRUE(come);
  EXPECT_EQ(come->kind, Kind::kConnected);
  EXPECT_EQ(come->controller, 7U);
  EXPECT_EQ(come->text, "control process connected: disarmed (started)");
  EXPECT_FALSE(look_after(900ms));
  EXPECT_TRUE(is_connected(view_, now_));
  const auto gone = look_after(200ms);
  ASSERT_TRUE(gone);
  EXPECT_EQ(gone->kind, Kind::kLost);
  EXPECT_EQ(gone->controller, 7U);
  EXPECT_FALSE(look_after(5s));
  hear(7);
  const auto back = look_after(10ms);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->kind, Kind::kConnected);
  EXPECT_EQ(back->text, "control process connected again: disarmed (started)");
}

TEST_F(Connection, ToAnotherProcessIsToldWithOrWithoutSilence) {
  hear(7);
  ASSERT_TRUE(look_after(0ms));
  hear(8);
  const auto at_once = look_after(100ms);
  ASSERT_TRUE(at_once);
  EXPECT_EQ(at_once->kind, Kind::kReplaced);
  EXPECT_EQ(at_once->controller, 8U);
  EXPECT_EQ(at_once->text, "another control process controls the vehicle: disarmed (started)");
  EXPECT_FALSE(look_after(100ms));
  EXPECT_EQ(look_after(2s)->kind, Kind::kLost);
  hear(9);
  EXPECT_EQ(look_after(0ms)->kind, Kind::kReplaced);
}

}  // namespace
}  // namespace swiftlet::ground
