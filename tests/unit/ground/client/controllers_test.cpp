#include "swiftlet/ground/client/controllers.hpp"

#include <string>

#include <gtest/gtest.h>

namespace swiftlet::ground::controllers_test {

using namespace std::chrono_literals;

const Clock::time_point kNow{1h};

msg::ControllerState state_of(std::uint64_t number, bool active, std::uint32_t failover_priority) {
  msg::ControllerState state;
  state.controller(number);
  state.role(active ? msg::ControllerState_Constants::ACTIVE : msg::ControllerState_Constants::STANDBY);
  state.failover_priority(failover_priority);
  return state;
}

// Controller 3 is active and publishes its status.
View view_of_status(std::chrono::milliseconds age = 0ms) {
  View view;
  msg::ControlStatus status;
  status.controller(3);
  view.control = {status, kNow - age, 1};
  return view;
}

std::string text_of(const View& view) {
  const LiveControllers controllers = controllers_of(view, kNow);
  std::string text;
  for (const LiveController& controller : controllers.known)
    text += std::to_string(controller.number) + (controller.active ? " active;" : " standby;");
  return text + std::to_string(controllers.others);
}

TEST(LiveControllers, AreTheActiveOneAndThenTheStandbysByPriority) {
  View view = view_of_status();
  view.controllers[1] = {state_of(1, false, 5), kNow, 1};
  view.controllers[2] = {state_of(2, false, 9), kNow, 1};
  view.controllers[3] = {state_of(3, true, 0), kNow, 1};
  view.peers["control"] = 3;
  EXPECT_EQ(text_of(view), "3 active;2 standby;1 standby;0");
}

TEST(LiveControllers, AreCountedWhileTheVehicleIsSilent) {
  View view = view_of_status();
  EXPECT_EQ(text_of(view), "3 active;0");
  EXPECT_FALSE(controllers_of(view, kNow).known[0].state);
  view.peers["control"] = 2;
  EXPECT_EQ(text_of(view), "3 active;1");
  EXPECT_EQ(controllers_of(view, kNow).count(), 2);
}

TEST(LiveControllers, AreNotThoseThatAreSilent) {
  View view = view_of_status(3s);
  view.controllers[1] = {state_of(1, false, 5), kNow - 2s, 1};
  EXPECT_EQ(text_of(view), "0");
}

}  // namespace swiftlet::ground::controllers_test
