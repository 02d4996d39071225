#include "swiftlet/ground/terminal/clock_text.hpp"

#include <fmt/core.h>

namespace swiftlet::ground {

std::string clock_text(const messages::msg::ClockStatus& clock) {
  std::string text = fmt::format("{:+.6f} s, {:+.1f} ppm", 1e-9 * static_cast<double>(clock.offset_ns()),
                                 1e6 * clock.drift());
  if (clock.steps() == 1) text += ", set once";
  if (clock.steps() > 1) text += fmt::format(", set {} times", clock.steps());
  return text;
}

}  // namespace swiftlet::ground
