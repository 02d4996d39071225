#include "swiftlet/services/plant/rotor_mapping.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::services::rotor_mapping_test {

using mavlink::HilActuatorControls;

plant::Vehicle vehicle(const std::string& name) {
  return io::load_vehicle(tests::in_source("config/vehicles/") + name + ".yaml");
}

HilActuatorControls armed(float first, float second, float third, float fourth) {
  HilActuatorControls controls;
  controls.mode = 1 | HilActuatorControls::kArmed;
  controls.controls = {first, second, third, fourth};
  return controls;
}

std::string refusal(const std::string& controls, const plant::Vehicle& of) {
  try {
    RotorMapping(controls, 0.0, 1.0, of);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "";
}

TEST(RotorMapping, Px4NumbersAQuadrotorByPlace) {
  // PX4: front right, rear left, front left, rear right.
  const HilActuatorControls controls = armed(0.125F, 0.25F, 0.375F, 0.5F);
  // Kaylion: front right, front left, rear left, rear right.
  plant::ActuatorCommand command = RotorMapping("px4", 0.0, 1.0, vehicle("kaylion")).command(controls);
  EXPECT_EQ(command.rotor_state, plant::RotorState::kRunning);
  EXPECT_EQ(command.rotor_count, 4);
  EXPECT_EQ(command.throttle, (plant::PerRotor{0.125, 0.375, 0.25, 0.5}));
  // Crazyflie: front right, rear right, rear left, front left.
  command = RotorMapping("px4", 0.0, 1.0, vehicle("crazyflie2")).command(controls);
  EXPECT_EQ(command.throttle, (plant::PerRotor{0.125, 0.5, 0.25, 0.375}));
  EXPECT_TRUE(spins_as_px4(vehicle("kaylion")));
  EXPECT_TRUE(spins_as_px4(vehicle("crazyflie2")));
}

TEST(RotorMapping, SpinOtherThanPx4IsFound) {
  plant::Vehicle other = vehicle("kaylion");
  for (plant::RotorMount& rotor : other.rotors) {
    rotor.spin =
        rotor.spin == plant::Spin::kClockwise ? plant::Spin::kCounterClockwise : plant::Spin::kClockwise;
  }
  EXPECT_FALSE(spins_as_px4(other));
}

TEST(RotorMapping, ListAndDirectNameControls) {
  const HilActuatorControls controls = armed(0.125F, 0.25F, 0.375F, 0.5F);
  EXPECT_EQ(RotorMapping("direct", 0.0, 1.0, vehicle("kaylion")).command(controls).throttle,
            (plant::PerRotor{0.125, 0.25, 0.375, 0.5}));
  EXPECT_EQ(RotorMapping("4,3,2,16", 0.0, 1.0, vehicle("kaylion")).command(controls).throttle,
            (plant::PerRotor{0.5, 0.375, 0.25, 0.0}));
}

TEST(RotorMapping, RangeIsMappedToTheThrottleAndLimited) {
  const RotorMapping mapping("direct", -1.0, 1.0, vehicle("kaylion"));
  EXPECT_EQ(mapping.command(armed(-1.0F, 0.0F, 1.0F, 3.0F)).throttle, (plant::PerRotor{0.0, 0.5, 1.0, 1.0}));
}

TEST(RotorMapping, RotorsAreOffUnlessArmed) {
  HilActuatorControls controls = armed(0.5F, 0.5F, 0.5F, 0.5F);
  controls.mode = 1;
  const plant::ActuatorCommand command = RotorMapping("px4", 0.0, 1.0, vehicle("kaylion")).command(controls);
  EXPECT_EQ(command.rotor_state, plant::RotorState::kOff);
  EXPECT_EQ(command.throttle, plant::PerRotor{});
}

TEST(RotorMapping, KeepsWhatIsNoNumberForTheWatchdog) {
  const HilActuatorControls controls = armed(0.5F, std::numeric_limits<float>::quiet_NaN(), 0.5F, 0.5F);
  EXPECT_TRUE(std::isnan(RotorMapping("direct", 0.0, 1.0, vehicle("kaylion")).command(controls).throttle[1]));
}

TEST(RotorMapping, RefusesWhatDoesNotFitTheVehicle) {
  plant::Vehicle plus = vehicle("kaylion");
  for (plant::RotorMount& rotor : plus.rotors)
    rotor.position_frd = Eigen::AngleAxisd(M_PI / 4.0, Eigen::Vector3d::UnitZ()) * rotor.position_frd;
  for (plant::RotorMount& rotor : plus.rotors) {
    for (int axis = 0; axis < 2; ++axis)
      if (std::abs(rotor.position_frd[axis]) < 1e-9) rotor.position_frd[axis] = 0.0;
  }
  EXPECT_NE(refusal("px4", plus).find("is no quadrotor in X"), std::string::npos);
  EXPECT_EQ(refusal("direct", plus), "");
  EXPECT_NE(refusal("1,2,,4", plus).find("rotor 3: is , must be a control from 1 to 16"), std::string::npos);
  EXPECT_NE(refusal("0,1,2,3", plus).find("rotor 1: is 0"), std::string::npos);
  EXPECT_NE(refusal("px5", plus).find("must be px4, direct, or one number"), std::string::npos);
}

}  // namespace swiftlet::services::rotor_mapping_test
