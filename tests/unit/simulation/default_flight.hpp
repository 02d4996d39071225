// KayLion in the simulated world of the default settings, flown in one process.
#pragma once

#include <gtest/gtest.h>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/record/evaluation.hpp"
#include "swiftlet/simulation/simulated_flight.hpp"

namespace swiftlet::simulation {

class DefaultFlight : public testing::Test {
 protected:
  // Arms, takes off to 1 m and holds.
  static void hover(ClosedLoop& loop) {
    ASSERT_TRUE(loop.step_until([&] { return loop.time_s() > 1.0; }, 2.0));
    control::Request request;
    request.kind = control::RequestKind::kArm;
    const control::Outcome armed = loop.controller.request(request);
    ASSERT_TRUE(armed.accepted) << armed.reason;
    request.kind = control::RequestKind::kTakeoff;
    request.position_ned.z() = -1.0;
    ASSERT_TRUE(loop.controller.request(request).accepted);
    ASSERT_TRUE(loop.step_until([&] { return mode(loop) == control::Mode::kHolding; }, 10.0));
    run(loop, 2.0);
  }
  static void land(ClosedLoop& loop) {
    control::Request request;
    request.kind = control::RequestKind::kLand;
    ASSERT_TRUE(loop.controller.request(request).accepted);
    ASSERT_TRUE(loop.step_until([&] { return mode(loop) == control::Mode::kDisarmed; }, 10.0));
  }
  static void run(ClosedLoop& loop, double duration_s) {
    const double end_s = loop.time_s() + duration_s;
    loop.step_until([&] { return loop.time_s() >= end_s; }, duration_s + 1.0);
  }
  static control::Mode mode(const ClosedLoop& loop) { return loop.controller.status().mode; }

  // Tracking errors from take-off to the start of the landing.
  static record::TrackingErrors fly_square(ClosedLoop& loop, const control::ControlSettings& settings) {
    control::Mission mission =
        io::load_mission_file(io::find_config("missions/square.yaml"), settings.limits).mission;
    mission.id = 1;
    record::Flight flight;
    const SimulatedFlight done =
        fly(loop, mission, io::planned_duration_s(mission, settings.limits), {&flight, nullptr, {}});
    EXPECT_TRUE(done.completed) << done.reason;
    EXPECT_LT(loop.plant.state().position_ned.norm(), 0.1) << "landed elsewhere";
    return record::evaluate(flight).errors;
  }

  plant::Vehicle vehicle_ = io::load_vehicle(io::find_config("vehicles/kaylion.yaml"));
  plant::SimulationSettings world_ = io::load_simulation_settings(io::find_config("simulation/default.yaml"));
  control::ControlSettings settings_ = io::load_control_settings(io::find_config("control/motor_lag.yaml"));
};

}  // namespace swiftlet::simulation
