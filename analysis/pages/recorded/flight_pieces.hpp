// The pieces from which the page of a flight is made.
#pragma once

#include <cstdint>

#include "swiftlet/analysis/pages/flight_log.hpp"
#include "swiftlet/record/evaluation.hpp"
#include "swiftlet/record/flight.hpp"
#include "swiftlet/record/mcap/reader.hpp"

namespace swiftlet::pages {

struct RecordedClock {
  std::int64_t zero_ns = 0;     // time 0 of the page on the vehicle's clock
  bool simulated_time = false;  // the log times are stamps
};

// Standard deviations of motion capture in the control settings; 0: not known.
struct PoseDeviation {
  double position_m = 0.0;
  double rotation_rad = 0.0;
};

// mode: a control::Mode. True from take-off to touchdown.
bool is_flying(int mode);

void add_signals(const record::Flight& recorded, const RecordedClock& clock, const PoseDeviation& deviation,
                 FlightLog& flight);
void add_events(const record::Flight& recorded, const RecordedClock& clock, FlightLog& flight);
void add_summary(const mcap::Reader& file, const record::Flight& recorded,
                 const record::TrackingErrors& errors, FlightLog& flight);

}  // namespace swiftlet::pages
