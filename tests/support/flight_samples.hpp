// The samples of a flight by stamp, and metrics of an interval of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::tests {

// Metrics of a time interval of the flight.
struct FlightMetrics {
  double longest_gap_ms = 0.0;       // without a newer command, on the vehicle's clock
  double largest_deviation_m = 0.0;  // of true position from reference
  double extra_deviation_m = 0.0;    // more than one period earlier, at the same point of the path
  double largest_step_m = 0.0;       // of the reference, beyond its velocity times the elapsed time
  int changes_of_controller = 0;
  double lowest_z_ned = 0.0;      // m; z points down
  double fastest_fall_m_s = 0.0;  // downwards
  double final_distance_m = 0.0;  // horizontal, between the places at the begin and the end of the interval
  std::size_t samples = 0;
};

// Receives what a node hears of its vehicle. Thread-safe.
class FlightSamples {
 public:
  explicit FlightSamples(dds::Node& node);

  // Stamp, speed and height of the vehicle's newest sample; 0: none yet.
  std::int64_t stamp_ns() const;
  double speed() const;  // m/s
  double z_ned() const;  // m
  // Between two stamps; the samples up to the second one should have arrived. period_ns: of a repeating path, 0 if none.
  FlightMetrics metrics(std::int64_t from_ns, std::int64_t to_ns, std::int64_t period_ns = 0) const;

 private:
  struct Truth {
    std::array<double, 3> position_ned{};
    std::array<double, 3> velocity_ned{};
  };

  std::optional<double> deviation_m(std::int64_t stamp_ns) const;  // with the lock held

  mutable std::mutex mutex_;                        // guards all maps
  std::map<std::int64_t, messages::msg::Imu> imu_;  // by stamp
  std::map<std::int64_t, Truth> truth_;
  std::map<std::int64_t, messages::msg::Reference> reference_;
  std::vector<dds::Subscription> subscriptions_;  // last: the callbacks use the members above
};

// Laps of a square with sides of 2 m at 1 m height, with vertical take-off and landing. Every side takes
// side_ns(speed).
control::Mission square_laps(double speed, int laps);
std::int64_t side_ns(double speed);

}  // namespace swiftlet::tests
