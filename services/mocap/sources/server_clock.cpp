#include "swiftlet/services/mocap/sources/server_clock.hpp"

namespace swiftlet::mocap {
namespace {

constexpr std::int64_t kOldest_ns = 1'000'000'000;  // of a stamp when it arrives
constexpr double kLead_ns = 1e6;  // by which a stamp may lie after its arrival, beyond the uncertainty

}  // namespace

void ServerClock::add(std::int64_t asked_ns, std::int64_t server_ns, std::int64_t arrived_ns) {
  filter_.add({asked_ns, server_ns, server_ns, arrived_ns});
}

bool ServerClock::is_known() const {
  return filter_.exchanges() >= clocks::ClockFilter::kStepExchanges && !filter_.is_in_doubt();
}

// The offset is a function of the host's time, which is what is asked for: one correction suffices, for a drift of 1e-4 of the
// age of the stamp.
std::optional<std::int64_t> ServerClock::to_host(std::int64_t server_ns, std::int64_t arrived_ns) const {
  if (!is_known()) return std::nullopt;
  const clocks::ClockEstimate& clock = *filter_.estimate();
  const std::int64_t about_ns = server_ns - clock.offset_ns;
  const std::int64_t host_ns = server_ns - clock.offset_at(about_ns);
  const double age_ns = static_cast<double>(arrived_ns - host_ns);
  if (age_ns > kOldest_ns || age_ns < -kLead_ns - clock.uncertainty_ns(arrived_ns)) return std::nullopt;
  return host_ns;
}

}  // namespace swiftlet::mocap
