// A supervised flight that flies missions.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/control/planning/waypoint_path.hpp"
#include "tests/unit/control/supervision/supervised_flight.hpp"

namespace swiftlet::control::mission_flight {

using Eigen::Vector3d;
using tests::SupervisedFlight;

inline MissionItem waypoint(const Vector3d& position_ned, double speed = 0.5, double hold_s = 0.0) {
  return {MissionItemKind::kWaypoint, position_ned, 0.0, true, speed, hold_s};
}

inline Mission mission_of(std::vector<MissionItem> items, std::uint64_t id = 7) {
  Mission mission;
  mission.id = id;
  mission.items = std::move(items);
  return mission;
}

// A curve in three axes, flown without stopping.
inline Mission curve(std::vector<Vector3d>* points = nullptr) {
  WaypointPath path;
  for (const Vector3d& p : {Vector3d(0, 0, -1), Vector3d(1, 0.5, -1.5), Vector3d(2, 0, -1),
                            Vector3d(1, -1, -0.8), Vector3d(0, 0, -1)}) {
    path.points.push_back({p, 0.0, false});
    if (points != nullptr) points->push_back(p);
  }
  path.limits = {1.5, 2.0, 20.0, 1.5};
  Mission mission = mission_of({});
  mission.segments = plan(path).segments;
  mission.items = {{MissionItemKind::kTrajectory, Vector3d::Zero(), 0.0, true, 0.5, 0.0, 0,
                    static_cast<std::uint32_t>(mission.segments.size())}};
  return mission;
}

// Distance of a position from the path of these segments, sampled every ms.
inline double distance_from(const std::vector<PolynomialSegment>& segments, const Vector3d& place) {
  double least = 1e9;
  for (const PolynomialSegment& segment : segments) {
    for (double t = 0.0; t <= segment.duration_s; t += 0.001)
      least = std::min(least, (evaluate(segment, t).position_ned - place).norm());
  }
  return least;
}

class MissionFlight : public testing::Test, protected SupervisedFlight {
 protected:
  void SetUp() override { ASSERT_TRUE(take_off()); }
  MissionState state() const { return supervisor_.mission().state; }
  int item() const { return supervisor_.mission().item_index; }
  Outcome pause() { return ask(RequestKind::kMissionPause); }
  Outcome resume() { return ask(RequestKind::kMissionResume); }
  void fly_for(double seconds) {
    step_until([] { return false; }, seconds);
  }

  // Steps and checks that the reference is continuous and that its derivatives match its position.
  void step_smoothly(double seconds, const Limits& limits = {}) {
    const double dt = static_cast<double>(kStep_ns) * 1e-9;
    std::optional<Reference> before;
    const std::int64_t end_ns = inputs_.stamp_ns + std::llround(seconds * 1e9);
    while (inputs_.stamp_ns < end_ns) {
      step();
      const Reference& r = control_setpoint_.reference;
      if (before) {
        const Vector3d velocity = (r.position_ned - before->position_ned) / dt;
        const Vector3d acceleration = (r.velocity_ned - before->velocity_ned) / dt;
        ASSERT_LT((velocity - 0.5 * (r.velocity_ned + before->velocity_ned)).norm(), 2e-4);
        ASSERT_LT((acceleration - 0.5 * (r.acceleration_ned + before->acceleration_ned)).norm(), 0.02);
        ASSERT_LT(r.acceleration_ned.norm(), 2.0 * limits.max_reference_acceleration + 1e-6);
      }
      before = r;
    }
  }
};

}  // namespace swiftlet::control::mission_flight
