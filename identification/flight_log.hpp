// Log of a flight for identification: IMU samples, motor commands and further optional signals.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::identification {

// Pose from motion capture, at the time of exposure.
struct FlightPose {
  double time_s = 0.0;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
};

// One row per IMU sample. A vector is empty if its signal was not recorded; otherwise it has one value per
// row. poses has a time base of its own.
struct FlightLog {
  std::string name;                                 // used in messages
  std::vector<double> time_s;                       // ascending
  std::vector<Eigen::Vector3d> specific_force_frd;  // m/s^2
  std::vector<Eigen::Vector3d> body_rates_frd;      // rad/s
  int rotor_count = 0;
  std::vector<plant::PerRotor>
      command;                // 0 .. 1, held from the row's time on: delta of Eq. (8) or that of another ESC
  std::vector<char> running;  // 1: rotors running
  std::vector<double> supply_voltage_v;
  std::vector<plant::PerRotor> rotor_speeds;  // rad/s
  std::vector<FlightPose> poses;              // in ascending order of time

  std::size_t size() const { return time_s.size(); }
};

}  // namespace swiftlet::identification
