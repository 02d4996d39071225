#include "swiftlet/services/clocks/clock_exchange.hpp"

#include <algorithm>
#include <initializer_list>

namespace swiftlet::clocks {
namespace {

// Offsets of stamps up to it, and differences of such offsets, do not overflow. 146 years.
constexpr std::int64_t kLargestStampNs = (std::int64_t{1} << 62) - 1;

bool is_out_of_range(std::int64_t stamp_ns) { return stamp_ns < 0 || stamp_ns > kLargestStampNs; }

}  // namespace

const char* fault_of(const ClockExchange& exchange) {
  const std::initializer_list<std::int64_t> stamps = {exchange.asked_ns, exchange.received_ns,
                                                      exchange.answered_ns, exchange.arrived_ns};
  if (std::any_of(stamps.begin(), stamps.end(), is_out_of_range)) return "a stamp is out of range";
  if (exchange.arrived_ns < exchange.asked_ns) return "the answer arrived before the question was sent";
  if (exchange.answered_ns < exchange.received_ns) return "it was answered before it was received";
  if (exchange.answered_ns - exchange.received_ns > kLongestExchangeNs) return "the answer took over 1 s";
  if (round_trip_ns(exchange) < 0) return "the round trip is negative";
  if (round_trip_ns(exchange) > kLongestExchangeNs) return "the round trip took over 1 s";
  return nullptr;
}

std::int64_t round_trip_ns(const ClockExchange& exchange) {
  return (exchange.arrived_ns - exchange.asked_ns) - (exchange.answered_ns - exchange.received_ns);
}

std::int64_t offset_ns(const ClockExchange& exchange) {
  return (exchange.received_ns - exchange.asked_ns) / 2 + (exchange.answered_ns - exchange.arrived_ns) / 2;
}

std::int64_t measured_ns(const ClockExchange& exchange) {
  return exchange.asked_ns + (exchange.arrived_ns - exchange.asked_ns) / 2;
}

}  // namespace swiftlet::clocks
