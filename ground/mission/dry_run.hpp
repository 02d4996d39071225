// A mission as it will be flown: the control service's own supervision flies it, in no time, with a vehicle
// that is exactly where it is asked to be. What comes out is the very path, with all that the service plans
// itself.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/settings.hpp"

namespace swiftlet::ground {

struct DryRunLeg {
  control::PolynomialSegment segment;
  double start_s = 0.0;  // since the mission's start
  std::size_t item = 0;  // of the mission, from 0
};

struct MissionDryRun {
  bool completed = false;
  std::string reason;                 // if not
  std::vector<DryRunLeg> legs;        // all that moves, without the last centimetres of the landing
  std::vector<double> item_starts_s;  // of each item
  double duration_s = 0.0;            // to the touch-down, or to the end of the last item
};

// start_ned: where it stands on the ground at z = 0, heading north; a mission that does not take off begins
// at kDryRunHover_m above there.
MissionDryRun dry_run(const control::Mission& mission, const control::ControlSettings& settings,
                      const Eigen::Vector2d& start_ned);
constexpr double kDryRunHover_m = 1.0;

}  // namespace swiftlet::ground
