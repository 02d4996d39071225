// A project that embeds this one: checks that the rotors carry the weight in hover.
#include <cmath>
#include <cstdio>

#include <swiftlet/plant/model/airframe.hpp>

int main() {
  using namespace swiftlet::plant;
  Vehicle vehicle;
  vehicle.mass_kg = 0.05;
  vehicle.rotor.thrust = 4e-8;
  vehicle.rotors.resize(4);
  const double thrust_n = vehicle.rotor.thrust * std::pow(hover_speed(vehicle), 2);
  std::printf("each rotor carries %.4f N\n", thrust_n);
  return std::abs(4.0 * thrust_n - vehicle.mass_kg * kGravity) < 1e-12 ? 0 : 1;
}
