#include "swiftlet/services/mocap/sources/server_clock.hpp"

namespace swiftlet::mocap {

void ServerClock::add(std::int64_t asked_ns, std::int64_t server_ns, std::int64_t arrived_ns) {
  filter_.add({asked_ns, server_ns, server_ns, arrived_ns});
}

bool ServerClock::is_known() const {
  return filter_.exchanges() >= comms::ClockFilter::kStepExchanges && !filter_.is_in_doubt();
}

// The offset is a function of the host's time, which is what is asked for: one correction suffices, for a drift of 1e-4 of the
// age of the stamp.
std::optional<std::int64_t> ServerClock::to_host(std::int64_t server_ns) const {
  if (!is_known()) return std::nullopt;
  const comms::ClockEstimate& clock = *filter_.estimate();
  const std::int64_t about_ns = server_ns - clock.offset_ns;
  return server_ns - clock.offset_at(about_ns);
}

double ServerClock::uncertainty_s(std::int64_t host_ns) const {
  return filter_.estimate() ? 1e-9 * filter_.estimate()->uncertainty_ns(host_ns) : 0.0;
}

}  // namespace swiftlet::mocap
