// What a page needs of the topics of one vehicle.
#pragma once

#include <string>

#include "swiftlet/ground/pages/flight_log.hpp"
#include "swiftlet/ground/pages/recorded/topic_table.hpp"

namespace swiftlet::pages {

struct FlightTopics {
  TopicTable truth, estimate, reference, imu, command, rotor_speeds, battery, pose, status, mission, vehicle,
      requests, request_results;
  // From the clock of the log to that of the vehicle: log time minus stamp, of the message with the least delay.
  std::int64_t log_minus_stamp_ns = 0;
  bool simulated_time = false;  // the log times are stamps
  double pose_deviation_m =
      0.0;  // standard deviations of motion capture in the control settings; 0: not known
  double pose_deviation_rad = 0.0;
};

FlightTopics read_flight_topics(const mcap::Reader& file, const std::string& vehicle);

// mode: a control::Mode. True from take-off to touchdown.
bool is_flying(double mode);

// Time 0 of the page on the vehicle's clock, ns.
std::int64_t zero_of(const FlightTopics& topics);

void add_signals(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight);
void add_events(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight);
void add_summary(const mcap::Reader& file, const FlightTopics& topics, FlightLog& flight);

}  // namespace swiftlet::pages
