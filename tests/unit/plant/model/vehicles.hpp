// Vehicles and random draws that the tests of plant/model share.
#pragma once

#include <cmath>
#include <random>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::tests {

// The vehicle of config/vehicles/kaylion.yaml.
inline const plant::Vehicle& kaylion() {
  static const plant::Vehicle vehicle = io::load_vehicle(in_source("config/vehicles/kaylion.yaml"));
  return vehicle;
}

// KayLion with another number of rotors, evenly around a circle from the front right on, spins alternating.
inline plant::Vehicle multirotor(int rotor_count) {
  plant::Vehicle vehicle = kaylion();
  vehicle.mass_kg *= rotor_count / 4.0;
  vehicle.rotors.clear();
  for (int i = 0; i < rotor_count; ++i) {
    const double angle = M_PI / rotor_count - 2.0 * M_PI * i / rotor_count;
    plant::RotorMount mount;
    mount.position_frd = 0.0695 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
    mount.spin = i % 2 == 0 ? plant::Spin::kCounterClockwise : plant::Spin::kClockwise;
    vehicle.rotors.push_back(mount);
  }
  return vehicle;
}

class UniformRandom {
 public:
  double operator()(double min, double max) {
    return std::uniform_real_distribution<double>(min, max)(generator_);
  }

 private:
  std::mt19937_64 generator_{20140527};
};

}  // namespace swiftlet::tests
