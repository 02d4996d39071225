// Arms, takes off, flies a mission file, streams setpoints, lands: example-fly-mission FILE [VEHICLE] [DOMAIN]
#include <cstdio>
#include <thread>

#include <swiftlet/ground/client/vehicle.hpp>
#include <swiftlet/ground/examples/arguments.hpp>
#include <swiftlet/io/missions/mission_file.hpp>

using namespace swiftlet::ground;

bool done(const char* what, const ActionHandle& action) {
  const ActionResult result = action.wait();
  std::printf("%s: %s\n", what, result.done() ? "done" : result.reason.c_str());
  return result.done();
}

int main(int argc, char** argv) try {
  const auto arguments = swiftlet::examples::read_arguments(argc, argv, {"FILE"});
  Vehicle vehicle(arguments.network);
  const auto mission = swiftlet::io::load_mission_file(arguments.own.front(), {}).mission;
  vehicle.on_connection([](const ConnectionEvent& event) { std::printf("%s\n", event.text.c_str()); });
  if (!done("arm", vehicle.arm())) return 1;
  bool flown = done("take off", vehicle.take_off(0.8)) && done("mission", vehicle.follow(mission));
  for (const double start_s = vehicle.clock_s(); flown && vehicle.clock_s() - start_s < 2.0;) {
    flown = vehicle.send(VelocitySetpoint{{0.2, 0.0, 0.0}});  // m/s north
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return done("land", vehicle.land()) && flown ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
