#include "swiftlet/plant/simulation/links/radio.hpp"

#include <cmath>

#include "swiftlet/math/time.hpp"

namespace swiftlet::plant {

std::optional<std::int64_t> RadioLink::send(std::int64_t now_ns) {
  if (!settings_.on()) return 0;
  const bool lost = random_.uniform() < settings_.loss;
  const double takes_s = settings_.delay_s + settings_.jitter_s * random_.uniform();
  if (now_ns == 0) return 0;
  if (lost) return std::nullopt;
  return math::nanoseconds(takes_s);
}

}  // namespace swiftlet::plant
