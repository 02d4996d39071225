// A mission flown elsewhere.
#pragma once

#include <Eigen/Core>

#include "swiftlet/control/types/mission.hpp"

namespace swiftlet::ground {

// The mission and its fence, shifted by by_ned, m. The shifted fence is clamped to that of the limits.
control::Mission shifted(control::Mission mission, const Eigen::Vector2d& by_ned,
                         const control::Limits& limits);

}  // namespace swiftlet::ground
