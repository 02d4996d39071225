// Flies a square of 1 m with the vehicle kl1: arm, take off, four places one after another, land.
//
//   swiftlet-plant & swiftlet-mocap & swiftlet-control &
//   example-fly-square [VEHICLE] [DOMAIN] [--localhost-only]
#include <cstdio>

#include <swiftlet/ground/client/vehicle.hpp>
#include <swiftlet/ground/examples/arguments.hpp>

namespace {

using swiftlet::ground::ActionHandle;
using swiftlet::ground::ActionResult;
using swiftlet::ground::Vehicle;

// Each request has been answered when it returns; here it is waited for its end too.
bool completed(const char* what, const ActionHandle& manoeuvre) {
  const ActionResult ending = manoeuvre.wait();
  if (ending.done()) {
    std::printf("%s: done\n", what);
  } else {
    std::fprintf(stderr, "%s: %s\n", what, ending.reason.c_str());
  }
  return ending.done();
}

bool fly(Vehicle& vehicle) {
  if (!completed("arm", vehicle.arm())) return false;
  if (!completed("take off", vehicle.take_off(1.0))) return false;
  // North, east and down of the origin: 1 m up is -1.
  const Eigen::Vector3d corners[] = {{1, 0, -1}, {1, 1, -1}, {0, 1, -1}, {0, 0, -1}};
  for (const Eigen::Vector3d& corner : corners) {
    Vehicle::Target place;
    place.position_ned_m = corner;
    place.speed_m_s = 0.8;
    if (!completed("go to", vehicle.go_to(place))) return false;
    std::printf("at (%.2f, %.2f, %.2f) m\n", vehicle.state().position_ned_m.x(),
                vehicle.state().position_ned_m.y(), vehicle.state().position_ned_m.z());
  }
  return completed("land", vehicle.land());
}

}  // namespace

int main(int argc, char** argv) {
  Vehicle vehicle(swiftlet::examples::network(argc, argv));
  const swiftlet::ground::Result there = vehicle.connect();
  if (!there.accepted()) {
    std::fprintf(stderr, "%s\n", there.reason.c_str());
    return 1;
  }
  if (fly(vehicle)) return 0;
  vehicle.land();  // whatever went wrong; refused on the ground
  return 1;
}
