// A short flight of made-up rows.
#pragma once

#include <cstdint>

#include "swiftlet/record/flight.hpp"

namespace swiftlet::analysis {

// Truth at 500 Hz, and a reference with every fifth sample up to `last_reference`.
inline record::Flight flown(int count, int last_reference) {
  record::Flight flight;
  for (int i = 0; i < count; ++i) {
    record::TruthRow truth;
    truth.stamp_ns = 1'000'000'000 + i * 2'000'000LL;
    truth.position_ned = {0.5 + 0.001 * i, 0.25, -1.0};
    truth.rotor_count = 4;
    truth.rotor_speeds = {1600, 1601, 1602, 1603};
    truth.supply_voltage_v = 4.1;
    flight.truth.push_back(truth);
    if (i % 5 != 0 || i > last_reference) continue;
    record::ReferenceRow reference;
    reference.stamp_ns = truth.stamp_ns;
    reference.mode = 4;
    reference.position_ned = {0.501 + 0.001 * i, 0.25, -1.0};
    reference.acceleration_ned = {0.0, 0.0, 0.25};
    reference.q_ned_from_frd = {0.8, 0.6, 0.0, 0.0};
    reference.thrust_n = 0.4;
    reference.moment_frd = {0.001, 0.002, 0.003};
    flight.reference.push_back(reference);
  }
  return flight;
}

}  // namespace swiftlet::analysis
