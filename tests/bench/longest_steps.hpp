// Times steps of plant and controller in which a request or setpoint is evaluated.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::tests {

struct StepTimes {
  std::string what;
  double median_us = 0.0;
  double longest_us = 0.0;
};

// CPU time of a step of plant and controller without a request, and of the steps that evaluate requests and
// setpoints of a vehicle in motion. Each flight is repeated; a step counts with its shortest time. Throws
// std::runtime_error if more than a tenth of the requests or setpoints of a kind were refused.
std::vector<StepTimes> longest_steps();

}  // namespace swiftlet::tests
