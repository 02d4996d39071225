// The hover test: compares a first low flight with the vehicle file, and names what is wrong with the vehicle before it goes far.
//
// Three comparisons run from lift-off on: the angular acceleration that the rotors are commanded to give with that of the gyro;
// the turn by the gyro with that of motion capture; the motion by the accelerometer with that of motion capture. Two of them
// tell which of three is wrong: rotors, gyro or motion capture. Tight limits end what none of them explains.
//
// Out: a sentence. No clock, no heap after construction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/supervision/axis_response.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

// What the controller knows at one sample.
struct HoverTestStep {
  std::int64_t stamp_ns = 0;
  double dt_s = 0.0;
  double ground_z_ned = 0.0;  // m
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();      // rad/s, bias removed
  Eigen::Vector3d specific_force_frd = Eigen::Vector3d::Zero();  // m/s^2, bias removed
  plant::PerRotor rotor_speeds{};                                // rad/s, as commanded
  bool commands_rotors = false;                                  // at level actuators
  bool lifted_off = false;
  double lift_ratio = 1.0;  // of the lift at lift-off and that of the vehicle file
};

class HoverTest {
 public:
  explicit HoverTest(const plant::Vehicle& vehicle);

  // Between tests.
  void reset();
  // A step of a test, on the ground or in flight, with dt_s > 0.
  void step(const HoverTestStep& now);
  // A pose that has arrived since the last step.
  void on_pose(const plant::PoseSample& pose);

  // What is wrong, a sentence with its terminating 0; empty: nothing so far.
  const VehicleFault& defect() const { return defect_; }

 private:
  static constexpr int kInputs = plant::kMaxRotors + 1;  // the last is a constant moment
  using RotorResponse = AxisResponse<kInputs>;
  using BodyResponse = AxisResponse<3>;

  // The motion by the sensors of the vehicle at a sample, to be compared with a pose of that time.
  struct Motion {
    std::int64_t stamp_ns = 0;
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();     // rad, in body axes, since lift-off
    Eigen::Vector3d way_ned = Eigen::Vector3d::Zero();  // m, high-passed
  };

  void begin(const HoverTestStep& now);
  void add_rotors(const HoverTestStep& now);
  void add_motion(const HoverTestStep& now);
  const Motion* motion_at(std::int64_t stamp_ns) const;
  double tilt(const HoverTestStep& now) const;
  void begin_rates(const HoverTestStep& now);
  void judge(bool last);
  void judge_lift(const HoverTestStep& now);
  void judge_limits(const HoverTestStep& now);
  RotorResponse::Gain rotor_gain(const std::array<int, plant::kMaxRotors>& order, double spin) const;
  void name_rotors(bool last);
  void name_weak_rotor();
  void name_axes(const char* subject, const BodyResponse& response, const char* const (&axes)[3]);
  void name(const char* text);

  Eigen::Matrix<double, 3, plant::kMaxRotors> acceleration_per_thrust_;  // (rad/s^2)/N
  double thrust_per_square_;
  int rotors_;

  VehicleFault defect_{};
  bool begun_ = false;
  bool tips_ = false;   // it turned over a foot when it lifted off
  bool clear_ = false;  // of the ground
  double clear_s_ = 0.0;
  Eigen::Vector3d up_frd_ = Eigen::Vector3d::Zero();  // of the standing vehicle
  double lifted_off_s_ = 0.0;
  Eigen::Vector3d start_ned_ = Eigen::Vector3d::Zero();
  RotorResponse rotor_response_;
  RotorResponse::Inputs thrusts_ = RotorResponse::Inputs::Zero();  // leaky integrals
  RotorResponse::Inputs smooth_thrusts_ = RotorResponse::Inputs::Zero();
  Eigen::Vector3d slow_rates_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d smooth_rates_ = Eigen::Vector3d::Zero();  // high-passed
  Eigen::Vector3d last_rates_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d noise_ = Eigen::Vector3d::Zero();        // (rad/s)^2, variance of a sample
  Eigen::Vector3d unexplained_ = Eigen::Vector3d::Zero();  // rad/s, of the last step
  bool commands_rotors_ = false;

  BodyResponse turn_response_;
  BodyResponse way_response_;
  Eigen::Vector3d turn_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d speed_ned_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d way_ned_ = Eigen::Vector3d::Zero();
  std::array<Motion, 64> motions_{};
  std::size_t motion_count_ = 0;
  bool has_pose_ = false;
  plant::PoseSample pose_;  // the last compared
  Motion at_pose_;
  Eigen::Vector3d turn_by_gyro_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_by_pose_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d slow_ned_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d slow_once_ned_ = Eigen::Vector3d::Zero();
};

}  // namespace swiftlet::control
