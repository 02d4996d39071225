#include "swiftlet/services/control/lockstep_gate.hpp"

#include <gtest/gtest.h>

namespace swiftlet::services::lockstep_gate_test {

using Inputs = plant::LockstepInputs;

VehicleSample imu(std::uint64_t number, std::uint64_t pose, std::uint64_t battery,
                  std::uint64_t rotor_speeds) {
  messages::msg::Imu message;
  message.sequence_number(number);
  message.lockstep().mocap_pose(pose);
  message.lockstep().battery(battery);
  message.lockstep().rotor_speeds(rotor_speeds);
  return vehicle_sample(message);
}

TEST(LockstepGate, PassesASampleWithoutDependenciesOnce) {
  LockstepGate gate;
  EXPECT_FALSE(gate.take().has_value());
  EXPECT_TRUE(gate.offer(imu(1, 0, 0, 0)));
  const auto first = gate.take();
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->sequence(), 1U);
  EXPECT_FALSE(gate.take().has_value());
  EXPECT_FALSE(gate.offer(imu(1, 0, 0, 0))) << "a repetition";
  EXPECT_FALSE(gate.take().has_value());
}

TEST(LockstepGate, HoldsASampleUntilItsDependenciesArrive) {
  LockstepGate gate;
  gate.offer(imu(7, 2, 3, 4));
  EXPECT_TRUE(gate.is_new(&Inputs::rotor_speeds, 4));
  EXPECT_FALSE(gate.take().has_value());
  EXPECT_TRUE(gate.is_new(&Inputs::mocap_pose, 2));
  EXPECT_FALSE(gate.take().has_value());
  EXPECT_TRUE(gate.is_new(&Inputs::battery, 2));
  EXPECT_FALSE(gate.take().has_value()) << "older than the one required";
  EXPECT_TRUE(gate.is_new(&Inputs::battery, 3));
  EXPECT_TRUE(gate.take().has_value());
}

TEST(LockstepGate, RecognisesOldSamplesPerStream) {
  LockstepGate gate;
  EXPECT_FALSE(gate.is_new(&Inputs::mocap_pose, 0)) << "0 is no sample";
  EXPECT_TRUE(gate.is_new(&Inputs::mocap_pose, 5));
  EXPECT_FALSE(gate.is_new(&Inputs::mocap_pose, 5));
  EXPECT_FALSE(gate.is_new(&Inputs::mocap_pose, 4));
  EXPECT_TRUE(gate.is_new(&Inputs::battery, 4)) << "each stream has its own counter";
}

}  // namespace swiftlet::services::lockstep_gate_test
