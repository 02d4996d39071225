#include "swiftlet/control/design/flown_delay.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "swiftlet/control/design/margins.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::control::flown_delay_test {

plant::Vehicle kaylion() { return io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")); }
ControlSettings settings(const std::string& name) {
  return io::load_control_settings(tests::in_source("config/control/") + name + ".yaml");
}

double slowest_pole(const Loop& loop) {
  double real = -1e9;
  for (const auto& pole : closed_loop_poles(loop)) real = std::max(real, pole.real());
  return real;
}

TEST(FlownDelay, IsTheBorderOfStability) {
  constexpr double kBeside_s = 1e-4;
  for (const char* name : {"motor_lag", "paper"}) {
    const ControlSettings of = settings(name);
    const ControlDesign design_of = design(kaylion(), of);
    const std::array<double, 6> margins_s = flown_delay_margins(design_of, of);
    for (std::size_t i = 0; i < margins_s.size(); ++i) {
      ASSERT_LT(margins_s[i], kLongestDelay_s) << name << ' ' << kFlownLoopNames[i];
      EXPECT_LT(slowest_pole(flown_loops(design_of, of, margins_s[i] - kBeside_s)[i].loop), 0.0);
      EXPECT_GT(slowest_pole(flown_loops(design_of, of, margins_s[i] + kBeside_s)[i].loop), 0.0);
    }
  }
}

// Without observers the delay acts on the loop that is cut at the rotor command: Pade agrees with the exact delay.
TEST(FlownDelay, OfTheAttitudeWithoutObserverIsThatOfItsPhaseMargin) {
  const ControlSettings of = settings("paper");
  const ControlDesign design_of = design(kaylion(), of);
  const double exact_s = margins(flown_loops(design_of, of, 0.0)[0].loop).delay_s;
  EXPECT_NEAR(flown_delay_margins(design_of, of)[0], exact_s, 1e-3 * exact_s);
}

TEST(FlownDelay, IsZeroForALoopThatIsUnstableWithoutDelay) {
  const ControlSettings of = settings("motor_lag");
  ControlDesign broken = design(kaylion(), of);
  broken.yaw.k = -broken.yaw.k;
  EXPECT_EQ(flown_delay_margins(broken, of)[2], 0.0);
}

}  // namespace swiftlet::control::flown_delay_test
