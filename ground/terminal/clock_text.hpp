// What is known of a clock that is not the vehicle's, in words.
#pragma once

#include <string>

#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::ground {

// "+3.000524 s, +50.2 ppm, set once".
std::string clock_text(const messages::msg::ClockStatus& clock);

}  // namespace swiftlet::ground
