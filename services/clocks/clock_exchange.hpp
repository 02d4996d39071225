// One exchange of stamps between two clocks, as in NTP.
#pragma once

#include <cstdint>

namespace swiftlet::clocks {

// A question and its answer, RFC 5905, section 8: T1 to T4, in ns. Each clock may have any origin.
struct ClockExchange {
  std::int64_t asked_ns = 0;     // T1, own clock
  std::int64_t received_ns = 0;  // T2, other clock
  std::int64_t answered_ns = 0;  // T3, other clock
  std::int64_t arrived_ns = 0;   // T4, own clock
};

// Longest round trip, and longest time that the other side may take to answer.
constexpr std::int64_t kLongestExchangeNs = 1'000'000'000;

// Why the stamps cannot be those of an exchange; nullptr if they can. The functions below hold only then.
const char* fault_of(const ClockExchange& exchange);

// Time on the way, both ways: (T4 - T1) - (T3 - T2).
std::int64_t round_trip_ns(const ClockExchange& exchange);
// Other clock minus own clock: ((T2 - T1) + (T3 - T4)) / 2. Wrong by at most half of the round trip.
std::int64_t offset_ns(const ClockExchange& exchange);
// When it was measured, on the own clock: half way between T1 and T4.
std::int64_t measured_ns(const ClockExchange& exchange);

}  // namespace swiftlet::clocks
