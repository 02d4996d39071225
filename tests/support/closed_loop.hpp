// Plant, mocap and flight controller in one thread, without DDS: each IMU sample is answered at its own
// stamp.
#pragma once

#include <functional>
#include <string>

#include "control/flight_controller.hpp"
#include "control/mission.hpp"
#include "control/settings.hpp"
#include "plant/simulation/actuator_watchdog.hpp"
#include "plant/simulation/mocap.hpp"
#include "plant/simulation/plant_simulation.hpp"

namespace swiftlet::test {

class ClosedLoop {
 public:
  ClosedLoop(const plant::Vehicle& vehicle, const plant::SimulationSettings& simulation,
             const control::ControlSettings& settings, std::uint64_t seed);

  // Up to the next IMU sample, and the controller's answer to it.
  void step();
  // Steps until the predicate holds; false if it does not within limit_s of simulated time.
  bool step_until(const std::function<bool()>& predicate, double limit_s);

  double time_s() const { return static_cast<double>(plant.stamp_ns()) * 1e-9; }
  // Position less reference, m NED; zero while the rotors are off.
  Eigen::Vector3d tracking_error() const;

  plant::PlantSimulation plant;
  plant::Mocap mocap;
  plant::ActuatorWatchdog watchdog;
  control::FlightController controller;
  plant::ActuatorCommand command;
  bool mocap_connected = true;
};

struct MissionResult {
  bool completed = false;
  std::string reason;
  double rms_3d_m = 0.0;
  double peak_3d_m = 0.0;
  double duration_s = 0.0;  // take-off to landing item
};

// Arms, flies the mission to its end, and takes the errors from its start to its landing item.
MissionResult fly(ClosedLoop& loop, const control::Mission& mission);

}  // namespace swiftlet::test
