// Uses the parts without DDS: reads the installed vehicle and settings, designs the gains, simulates a fall.
#include <cmath>
#include <cstdio>
#include <string>

#include <swiftlet/control/design/control_design.hpp>
#include <swiftlet/io/settings/control_settings_file.hpp>
#include <swiftlet/io/settings/vehicle_file.hpp>
#include <swiftlet/plant/simulation/dynamics.hpp>

int main(int argc, char** argv) {
  using namespace swiftlet;
  if (argc != 2) return 2;
  const std::string config = argv[1];
  plant::Vehicle vehicle = io::load_vehicle(config + "/vehicles/kaylion.yaml");
  const auto settings = io::load_control_settings(config + "/control/paper.yaml");

  // The double integrator's closed form for Q = diag(q1, q2): k1^2 = q1 / r, k2^2 = q2 / r + 2 k1.
  const auto roll = control::design(vehicle, settings).roll;
  const double k1 = std::sqrt(roll.weights.q[0] / roll.weights.r);
  const double k2 = std::sqrt(roll.weights.q[1] / roll.weights.r + 2.0 * k1);
  std::printf("roll gains %.3f %.3f\n", roll.k[0], roll.k[1]);
  if (std::abs(roll.k[0] - k1) > 1e-6 || std::abs(roll.k[1] - k2) > 1e-6) return 1;

  vehicle.linear_drag = 0.0;
  const plant::Dynamics dynamics(vehicle, plant::Supply::battery());
  plant::VehicleState state;
  for (int i = 0; i < 1000; ++i) dynamics.advance(state, {}, Eigen::Vector3d::Zero(), 1e-3);
  std::printf("fallen %.6f m in 1 s\n", state.position_ned.z());
  return std::abs(state.position_ned.z() - 0.5 * plant::kGravity) < 1e-9 ? 0 : 1;
}
