#include "swiftlet/services/control/takeover.hpp"

#include <fmt/core.h>

namespace swiftlet::services {
namespace {

// A vehicle stops its rotors by itself long before (docs/vehicle.md): nothing is taken over.
constexpr std::int64_t kFlightIsOverNs = 1'000'000'000;

double ms(std::int64_t ns) { return 1e-6 * static_cast<double>(ns); }

}  // namespace

std::string to_string(const Takeover& takeover) {
  const std::string delay =
      takeover.delay_p95_ns < 0
          ? "it is not known for how long commands are under way"
          : fmt::format("95 % of the commands need up to {:.0f} ms", ms(takeover.delay_p95_ns));
  std::string turn;
  if (takeover.rank > 0)
    turn = fmt::format(", {} standby{} before it", takeover.rank, takeover.rank == 1 ? "" : "s");
  const std::string obeyed =
      takeover.obeyed ? fmt::format("the vehicle obeyed after {:.0f} ms", ms(takeover.longest_silence_ns))
                      : "the vehicle has not reported that it obeys";
  if (!takeover.continues && takeover.silence_ns > kFlightIsOverNs)
    return fmt::format("commands the vehicle, which has had no command for {:.1f} s; {}",
                       1e-3 * ms(takeover.silence_ns), obeyed);
  return fmt::format(
      "takes over{}: {:.0f} ms without a new command, waited for {:.0f} ms ({}{}); {}; the longest pause "
      "between two samples was {:.0f} ms",
      takeover.continues ? "" : " without the state of the flight", ms(takeover.silence_ns),
      ms(takeover.patience_ns), delay, turn, obeyed, ms(takeover.longest_pause_ns));
}

}  // namespace swiftlet::services
