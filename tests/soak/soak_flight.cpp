#include "tests/soak/soak_flight.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/closed_loop.hpp"
#include "swiftlet/simulation/dispersion_file.hpp"
#include "tests/soak/fault_draw.hpp"

namespace swiftlet::soak {
namespace {

using control::cosine_of_tilt;
using control::Mode;
using Eigen::Vector3d;
using plant::Fault;

constexpr double kFlight_s = 120.0;
constexpr double kFirstFault_s = 3.0;
constexpr double kAftermath_s = 1.0;
constexpr double kLyingCosine = 0.5;  // of the tilt: 60 degrees
constexpr double kLies_s = 3.0;       // on the ground, tilted, rotors off

template <typename... Values>
std::string text(const char* format, Values... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

class Run {
 public:
  Run(const SoakSetup& setup, std::uint64_t seed, const Log& log)
      : limits_(setup.control.limits),
        log_(log),
        world_(world(setup, seed)),
        loop_(world_.vehicle, setup.nominal.vehicle, world_.simulation, setup.control, seed),
        pilot_(seed, limits_, log ? Log([this](const std::string& what) { log_event(what); }) : Log()) {
    flight_.seed = seed;
    for (const Fault& fault : world_.simulation.faults)
      flight_.faults.push_back({fault, Consequence::kOnGround});
  }

  SoakFlight fly() {
    while (loop_.time_s() < kFlight_s && !flight_.violation && !flight_.lies) {
      const Mode before = loop_.controller.status().mode;
      report_faults();
      pilot_.act(loop_);
      const Mode after_requests = loop_.controller.status().mode;
      loop_.step();
      update_consequences(before, after_requests);
    }
    if (!flight_.violation && upside_down() && rotors_running())
      violate("ended upside down with its rotors running");
    flight_.simulated_s = loop_.time_s();
    flight_.take_offs = pilot_.take_offs();
    return flight_;
  }

 private:
  static simulation::World world(const SoakSetup& setup, std::uint64_t seed) {
    simulation::World world = simulation::draw(setup.dispersion, setup.nominal, seed).world;
    world.simulation.faults =
        draw_faults(seed, kFirstFault_s, kFlight_s, world.vehicle, setup.control.limits);
    return world;
  }

  bool rotors_running() const {
    return loop_.firmware.rotor_state(loop_.plant.stamp_ns()) == plant::RotorState::kRunning;
  }
  bool upside_down() const { return cosine_of_tilt(loop_.plant.state().q_ned_from_frd) < 0.0; }
  bool airborne() const { return !loop_.plant.on_ground(); }

  void update_consequences(Mode before, Mode after_requests) {
    const Mode mode = loop_.controller.status().mode;
    if (mode != before && log_)
      log_event(std::string("mode: ") + to_string(mode) + ", " + to_string(loop_.controller.status().reason));
    const double step_s = loop_.time_s() - last_step_s_;
    last_step_s_ = loop_.time_s();
    if (airborne()) flight_.airborne_s += step_s;

    if (airborne()) record_consequence(Consequence::kFlewOn);
    if (mode != after_requests && mode == Mode::kLanding) record_consequence(Consequence::kLanded);
    if (mode != after_requests && mode == Mode::kDescent) record_consequence(Consequence::kDescended);
    if (mode != after_requests && mode == Mode::kStopped) record_consequence(Consequence::kStopped);
    if (airborne() && was_running_ && !rotors_running() && mode != Mode::kDisarmed) {
      if (log_) log_event(std::string("the rotors stop in the air"));
      record_consequence(Consequence::kFell);
    }
    was_running_ = rotors_running();
    check_fence();
    check_attitude(step_s);
  }

  void record_consequence(Consequence consequence) {
    for (MetFault& met : flight_.faults) {
      const double now_s = loop_.time_s();
      if (now_s < met.fault.at_s || now_s > met.fault.at_s + met.fault.for_s + kAftermath_s) continue;
      met.consequence = std::max(met.consequence, consequence);
    }
  }

  void check_fence() {
    const Vector3d& p = loop_.plant.state().position_ned;
    const double outside =
        std::max((p - limits_.fence_max_ned).maxCoeff(), (limits_.fence_min_ned - p).maxCoeff());
    flight_.most_outside_m = std::max(flight_.most_outside_m, outside);
    if (outside > kFenceMargin_m) violate(text("%.2f m outside the fence", outside));
  }

  void check_attitude(double step_s) {
    upside_down_s_ = upside_down() && rotors_running() ? upside_down_s_ + step_s : 0.0;
    if (upside_down_s_ > kUpsideDown_s)
      violate(text("upside down with its rotors running for %.1f s", upside_down_s_));
    const bool lies = loop_.plant.on_ground() && !rotors_running() &&
                      cosine_of_tilt(loop_.plant.state().q_ned_from_frd) < kLyingCosine;
    lies_s_ = lies ? lies_s_ + step_s : 0.0;
    if (lies_s_ > kLies_s) {
      flight_.lies = true;
      if (log_) log_event("lies on the ground");
    }
  }

  void violate(const std::string& what) {
    if (flight_.violation) return;
    flight_.violation = Violation{loop_.time_s(), what};
    if (log_) log_event("VIOLATION: " + what);
  }

  void log_event(const std::string& what) {
    const plant::VehicleState& state = loop_.plant.state();
    const Vector3d& p = state.position_ned;
    const Vector3d error = loop_.controller.estimate().position_ned - p;
    log_(text("%8.3f s  (%5.2f, %5.2f, %5.2f) m, tilt %3.0f deg, estimate off %5.2f m, %4.1f deg: %s",
              loop_.time_s(), p.x(), p.y(), p.z(),
              std::acos(std::clamp(cosine_of_tilt(state.q_ned_from_frd), -1.0, 1.0)) * 180.0 / M_PI,
              error.norm(),
              loop_.controller.estimate().q_ned_from_frd.angularDistance(state.q_ned_from_frd) * 180.0 / M_PI,
              what.c_str()));
  }

  void report_faults() {
    if (!log_) return;
    for (const MetFault& met : flight_.faults) {
      if (reported_until_s_ < met.fault.at_s && met.fault.at_s <= loop_.time_s())
        log_event(text("fault: %s for %.3f s", plant::to_string(met.fault.kind), met.fault.for_s));
    }
    reported_until_s_ = loop_.time_s();
  }

  const control::Limits& limits_;
  const Log& log_;
  simulation::World world_;
  simulation::ClosedLoop loop_;
  Pilot pilot_;
  SoakFlight flight_;
  double last_step_s_ = 0.0;
  double reported_until_s_ = 0.0;
  bool was_running_ = false;
  double upside_down_s_ = 0.0;
  double lies_s_ = 0.0;
};

}  // namespace

SoakSetup load_setup(const std::string& control) {
  SoakSetup setup;
  setup.nominal.vehicle = io::load_vehicle(io::configuration_file(io::kinds::kVehicle, "kaylion"));
  setup.nominal.simulation =
      io::load_simulation_settings(io::configuration_file(io::kinds::kSimulation, "default"));
  setup.control = io::load_control_settings(io::configuration_file(io::kinds::kControl, control));
  setup.dispersion = simulation::load_dispersion_file(
      io::configuration_file(io::kinds::kDispersion, "kaylion"), setup.nominal);
  return setup;
}

SoakFlight fly(const SoakSetup& setup, std::uint64_t seed, const Log& log) {
  return Run(setup, seed, log).fly();
}

}  // namespace swiftlet::soak
