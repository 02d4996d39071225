// What was recorded of a flight: the samples of an IMU, the commands that the motors got, and whatever else
// was there.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::identification {

// Motion capture, at the time of the exposure.
struct FlightPose {
  double time_s = 0.0;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
};

// A row for each IMU sample. Vectors of what was not recorded are empty, all others have a value for each
// row.
struct FlightLog {
  std::string name;                                 // for messages
  std::vector<double> time_s;                       // rising
  std::vector<Eigen::Vector3d> specific_force_frd;  // m/s^2
  std::vector<Eigen::Vector3d> body_rates_frd;      // rad/s
  int rotor_count = 0;
  std::vector<plant::PerRotor>
      command;  // 0 .. 1 of full command, from the row's time on: delta of Eq. (8), or another's own
  std::vector<char> running;  // 1: the rotors run
  std::vector<double> supply_voltage_v;
  std::vector<plant::PerRotor> rotor_speeds;  // rad/s
  std::vector<FlightPose> poses;              // times rising

  std::size_t size() const { return time_s.size(); }
};

}  // namespace swiftlet::identification
