// The events of the page, from the topics of a vehicle.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/pages/recorded/flight_topics.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::pages {
namespace {

// By the values of Command.kind.
constexpr std::array<const char*, 12> kRequests = {
    "arm",  "disarm",        "take off",      "go to",          "hold",         "land",
    "stop", "start mission", "pause mission", "resume mission", "skip an item", "clear the mission"};
// By the values of MissionStatus.state.
constexpr std::array<const char*, 6> kMissionStates = {"none",    "running",  "completed",
                                                       "aborted", "uploaded", "paused"};
// By the values of Estimate.pose_fault.
constexpr std::array<const char*, 7> kPoseFaults = {"none",    "not tracked",     "invalid", "untimely",
                                                    "outlier", "swapped markers", "frozen"};

template <std::size_t kCount>
std::string name_of(const std::array<const char*, kCount>& names, double value) {
  const bool known = value >= 0.0 && value < static_cast<double>(kCount);
  return known ? names[static_cast<std::size_t>(value)] : fmt::format("{:g}", value);
}

class Events {
 public:
  Events(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight)
      : topics_(topics), zero_ns_(zero_ns), flight_(flight) {}

  void add_modes() {
    const TopicTable& status = topics_.status;
    double mode = -1.0;
    for (std::size_t i = 0; i < status.rows(); ++i) {
      if (status.number("mode", i) == mode) continue;
      mode = status.number("mode", i);
      const std::string name = control::to_string(static_cast<control::Mode>(mode));
      flight_.modes.push_back({time_of(status, i), name});
      add(status, i, "mode", name + ": " + status.text("reason", i));
    }
    add_sentences(status, "source_conflict", "vehicle");
    add_sentences(status, "setpoint_refusal", "request");
    add_sentences(topics_.vehicle, "fault", "vehicle");
  }

  void add_mission() {
    const TopicTable& mission = topics_.mission;
    std::string last;
    for (std::size_t i = 0; i < mission.rows(); ++i) {
      const double state = mission.number("state", i);
      if (state == 0.0) continue;
      std::string text = "mission " + name_of(kMissionStates, state);
      if (state == 1.0)
        text += fmt::format(", item {:g} of {:g}", mission.number("item_index", i) + 1.0,
                            mission.number("item_count", i));
      if (!mission.text("reason", i).empty()) text += ": " + mission.text("reason", i);
      if (text != last) add(mission, i, "mission", text, state == 3.0);
      last = text;
    }
  }

  void add_requests() {
    for (std::size_t i = 0; i < topics_.requests.rows(); ++i) {
      // A request has no stamp.
      add_at(topics_.requests.log_ns[i] - topics_.log_minus_stamp_ns, "request",
             "request: " + name_of(kRequests, topics_.requests.number("kind", i)));
    }
    const TopicTable& results = topics_.request_results;
    for (std::size_t i = 0; i < results.rows(); ++i) {
      const std::string reason = results.text("reason", i);
      if (results.number("accepted", i) != 0.0) continue;
      add_at(results.log_ns[i] - topics_.log_minus_stamp_ns, "request", "request refused: " + reason, true);
    }
  }

  void add_estimator() {
    const TopicTable& estimate = topics_.estimate;
    double fault = 0.0;
    double resets = estimate.rows() > 0 ? estimate.number("resets", 0) : 0.0;
    for (std::size_t i = 0; i < estimate.rows(); ++i) {
      if (estimate.number("resets", i) > resets)
        add(estimate, i, "estimator", "estimate reset to the poses", true);
      resets = estimate.number("resets", i);
      const double now = estimate.number("pose_fault", i);
      if (now != fault && now > 0.0)
        add(estimate, i, "estimator", "pose refused: " + name_of(kPoseFaults, now), true);
      fault = now;
    }
  }

 private:
  double time_of(const TopicTable& table, std::size_t row) const { return time_at(table.stamp_ns[row]); }
  double time_at(std::int64_t stamp_ns) const {
    return static_cast<double>(stamp_ns - zero_ns_) / math::kNsPerS;
  }
  void add(const TopicTable& table, std::size_t row, const char* kind, std::string text,
           bool warning = false) {
    add_at(table.stamp_ns[row], kind, std::move(text), warning);
  }
  void add_at(std::int64_t stamp_ns, const char* kind, std::string text, bool warning = false) {
    flight_.events.push_back({time_at(stamp_ns), kind, std::move(text), warning});
  }
  // A text that appears or changes.
  void add_sentences(const TopicTable& table, const char* column, const char* kind) {
    std::string last;
    for (std::size_t i = 0; i < table.rows(); ++i) {
      const std::string text = table.text(column, i);
      if (text != last && !text.empty()) add(table, i, kind, text, true);
      last = text;
    }
  }

  const FlightTopics& topics_;
  const std::int64_t zero_ns_;
  FlightLog& flight_;
};

}  // namespace

void add_events(const FlightTopics& topics, std::int64_t zero_ns, FlightLog& flight) {
  Events events(topics, zero_ns, flight);
  events.add_modes();
  events.add_mission();
  events.add_requests();
  events.add_estimator();
  std::stable_sort(flight.events.begin(), flight.events.end(),
                   [](const FlightEvent& a, const FlightEvent& b) { return a.time_s < b.time_s; });
}

}  // namespace swiftlet::pages
