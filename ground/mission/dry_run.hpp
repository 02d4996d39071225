// Mission dry run: the control service's own supervisor flies the mission faster than real time, with an
// ideal vehicle that is always at its reference. The result is the exact path, including the parts that the
// service plans itself.
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
  double start_s = 0.0;  // since the start of the mission
  std::size_t item = 0;  // index of the mission's item, from 0
};

struct MissionDryRun {
  bool completed = false;
  std::string reason;                 // why it is not completed
  std::vector<DryRunLeg> legs;        // all moves, without the last centimetres of the landing
  std::vector<double> item_starts_s;  // of each item
  double duration_s = 0.0;            // to the touchdown, or to the end of the last item
};

// start_ned: m, the vehicle stands there on the ground at z = 0, heading north. A mission without a take-off
// starts at kDryRunHover_m above it.
MissionDryRun dry_run(const control::Mission& mission, const control::ControlSettings& settings,
                      const Eigen::Vector2d& start_ned);
constexpr double kDryRunHover_m = 1.0;

}  // namespace swiftlet::ground
