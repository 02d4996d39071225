// Flies a square with sides of 1 m: arms, takes off, goes to four corners, lands. Default vehicle: kl1.
//
//   swiftlet-plant & swiftlet-mocap & swiftlet-control &
//   example-fly-square [VEHICLE] [DOMAIN] [--open-network]
#include <cstdio>

#include <swiftlet/ground/client/vehicle.hpp>
#include <swiftlet/ground/examples/arguments.hpp>

namespace {

using swiftlet::ground::ActionHandle;
using swiftlet::ground::ActionResult;
using swiftlet::ground::Vehicle;

// A request returns once the controller has answered it. This also waits until the action ends.
bool completed(const char* what, const ActionHandle& action) {
  const ActionResult result = action.wait();
  if (result.done()) {
    std::printf("%s: done\n", what);
  } else {
    std::fprintf(stderr, "%s: %s\n", what, result.reason.c_str());
  }
  return result.done();
}

bool fly(Vehicle& vehicle) {
  if (!completed("arm", vehicle.arm())) return false;
  if (!completed("take off", vehicle.take_off(1.0))) return false;
  // m, north, east and down of the origin: 1 m up is -1.
  const Eigen::Vector3d corners[] = {{1, 0, -1}, {1, 1, -1}, {0, 1, -1}, {0, 0, -1}};
  for (const Eigen::Vector3d& corner : corners) {
    Vehicle::Target target;
    target.position_ned_m = corner;
    target.speed_m_s = 0.8;
    if (!completed("go to", vehicle.go_to(target))) return false;
    std::printf("at (%.2f, %.2f, %.2f) m\n", vehicle.state().position_ned_m.x(),
                vehicle.state().position_ned_m.y(), vehicle.state().position_ned_m.z());
  }
  return completed("land", vehicle.land());
}

}  // namespace

int main(int argc, char** argv) try {
  Vehicle vehicle(swiftlet::examples::read_arguments(argc, argv).network);
  const swiftlet::ground::Result connection = vehicle.connect();
  if (!connection.accepted()) {
    std::fprintf(stderr, "%s\n", connection.reason.c_str());
    return 1;
  }
  if (fly(vehicle)) return 0;
  vehicle.land();  // after any failure; refused on the ground
  return 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
