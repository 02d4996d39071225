// What the memory of a hover test distinguishes.
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/ground/cli/hover_test.hpp"

namespace swiftlet::ground::hover_test_memory_test {

std::shared_ptr<const msg::FlownFiles> with_hashes(const char* vehicle, const char* control) {
  auto files = std::make_shared<msg::FlownFiles>();
  files->vehicle().sha256() = vehicle;
  files->control().sha256() = control;
  return files;
}

TEST(HoverTestMemory, AVehicleThatChangesIsAnotherOne) {
  const std::string before = tested_configuration(View());
  EXPECT_EQ(tested_configuration(View()), before);
  const std::vector<std::function<void(View&)>> changes = {
      [](View& view) { view.vehicle.message.name() = "kaylion"; },
      [](View& view) { view.vehicle.message.mass_kg(0.05); },
      [](View& view) { view.vehicle.message.rotor_count(6); },
      [](View& view) { view.vehicle.message.autopilot() = "px4"; },
      [](View& view) { view.control.message.control_level(4); },
      [](View& view) { view.files = with_hashes("a", ""); },
      [](View& view) { view.files = with_hashes("", "a"); },
  };
  for (const auto& change : changes) {
    View view;
    change(view);
    EXPECT_NE(tested_configuration(view), before);
  }
  View flown;
  flown.control.message.stamp_ns(7);
  flown.vehicle.message.boot(7);
  EXPECT_EQ(tested_configuration(flown), before);
}

TEST(HoverTestMemory, LiesInTheStateFolder) {
  ASSERT_EQ(setenv("XDG_STATE_HOME", "/state", 1), 0);
  EXPECT_EQ(hover_test_memory("kl1"), "/state/swiftlet/hover_tests/kl1");
  unsetenv("XDG_STATE_HOME");
}

}  // namespace swiftlet::ground::hover_test_memory_test
