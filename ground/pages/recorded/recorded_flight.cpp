#include "swiftlet/ground/pages/recorded/recorded_flight.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "swiftlet/ground/pages/recorded/flight_topics.hpp"
#include "swiftlet/ground/recording/log_table.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/natural_order.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::pages {
namespace {

// Those whose topics /<vehicle>/estimate or /<vehicle>/ground_truth have messages.
std::vector<std::string> vehicles_of(const mcap::Reader& file) {
  std::set<std::string> vehicles;
  for (const auto& [id, channel] : file.channels()) {
    const std::size_t end = channel.topic.find('/', 1);
    if (end == std::string::npos) continue;
    const std::string topic = channel.topic.substr(end + 1);
    const auto count = file.statistics().messages_by_channel.find(id);
    const bool empty = count == file.statistics().messages_by_channel.end() || count->second == 0;
    if (!empty && (topic == "estimate" || topic == "ground_truth"))
      vehicles.insert(channel.topic.substr(1, end - 1));
  }
  std::vector<std::string> names(vehicles.begin(), vehicles.end());
  std::sort(names.begin(), names.end(), runtime::comes_before);
  return names;
}

void set_range(FlightLog& flight) {
  flight.start_s = std::numeric_limits<double>::max();
  flight.end_s = std::numeric_limits<double>::lowest();
  for (const auto& [name, table] : flight.tables) {
    if (table.time_s.empty()) continue;
    flight.start_s = std::min(flight.start_s, table.time_s.front());
    flight.end_s = std::max(flight.end_s, table.time_s.back());
  }
}

FlightLog flight_of(const mcap::Reader& file, const std::string& vehicle) {
  const FlightTopics topics = read_flight_topics(file, vehicle);
  const std::int64_t zero_ns = zero_of(topics);
  FlightLog flight;
  flight.vehicle = vehicle;
  flight.has_truth = topics.truth.rows() > 0;
  if (!topics.simulated_time)
    flight.wall_start_s = static_cast<double>(zero_ns + topics.log_minus_stamp_ns) / math::kNsPerS;
  add_signals(topics, zero_ns, flight);
  add_events(topics, zero_ns, flight);
  set_range(flight);
  add_summary(file, topics, flight);
  return flight;
}

}  // namespace

std::vector<FlightLog> flights_in(const mcap::Reader& file, const std::string& name) {
  const std::vector<std::string> vehicles = vehicles_of(file);
  if (vehicles.empty())
    throw runtime::ConfigError(file.name(), 0, "",
                               "holds no flight: no topic /<vehicle>/estimate or ground_truth");
  std::vector<FlightLog> flights;
  for (const std::string& vehicle : vehicles) {
    flights.push_back(flight_of(file, vehicle));
    flights.back().name = vehicles.size() == 1 ? name : name + " " + vehicle;
  }
  return flights;
}

}  // namespace swiftlet::pages
