// The events of the page, from the topics of a vehicle.
#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/analysis/pages/recorded/flight_pieces.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::pages {
namespace {

// By the values of MissionStatus.state.
constexpr std::array<const char*, 6> kMissionStates = {"none",    "running",  "completed",
                                                       "aborted", "uploaded", "paused"};
// By the values of Estimate.pose_fault.
constexpr std::array<const char*, 7> kPoseFaults = {"none",    "not tracked",     "invalid", "untimely",
                                                    "outlier", "swapped markers", "frozen"};

template <std::size_t kCount>
std::string name_of(const std::array<const char*, kCount>& names, int value) {
  const bool known = value >= 0 && value < static_cast<int>(kCount);
  return known ? names[static_cast<std::size_t>(value)] : std::to_string(value);
}

class Events {
 public:
  Events(const record::Flight& recorded, std::int64_t zero_ns, FlightLog& flight)
      : recorded_(recorded), zero_ns_(zero_ns), flight_(flight) {}

  void add_modes() {
    int mode = -1;
    for (const record::StatusRow& status : recorded_.status) {
      if (status.mode == mode) continue;
      mode = status.mode;
      const std::string name = control::to_string(static_cast<control::Mode>(mode));
      flight_.modes.push_back({time_at(status.stamp_ns), name});
      add(status.stamp_ns, "mode", name + ": " + status.reason);
    }
    add_sentences(recorded_.status, &record::StatusRow::source_conflict, "vehicle");
    add_sentences(recorded_.status, &record::StatusRow::setpoint_refusal, "request");
    add_sentences(recorded_.vehicle, &record::VehicleRow::fault, "vehicle");
  }

  void add_mission() {
    std::string last;
    for (const record::MissionRow& mission : recorded_.mission) {
      const auto state = static_cast<control::MissionState>(mission.state);
      if (state == control::MissionState::kNone) continue;
      std::string text = "mission " + name_of(kMissionStates, mission.state);
      if (state == control::MissionState::kRunning)
        text += fmt::format(", item {} of {}", mission.item_index + 1, mission.item_count);
      if (!mission.reason.empty()) text += ": " + mission.reason;
      if (text != last) add(mission.stamp_ns, "mission", text, state == control::MissionState::kAborted);
      last = text;
    }
  }

  void add_requests() {
    for (const record::RequestRow& request : recorded_.requests)
      add(stamp_of(request), "request",
          std::string("request: ") + control::to_string(static_cast<control::RequestKind>(request.kind)));
    for (const record::RequestRow& answer : recorded_.answers) {
      if (!answer.accepted) add(stamp_of(answer), "request", "request refused: " + answer.reason, true);
    }
  }

  void add_faults() {
    std::int64_t end_ns = recorded_.truth.empty() ? 0 : recorded_.truth.back().stamp_ns;
    if (!recorded_.estimate.empty()) end_ns = std::max(end_ns, recorded_.estimate.back().stamp_ns);
    for (const record::FaultRow& fault : recorded_.faults) {
      if (fault.from_ns <= end_ns) add(fault.from_ns, "fault", "fault: " + fault.text, true);
    }
  }

  void add_estimator() {
    int fault = 0;
    double resets = recorded_.estimate.empty() ? 0.0 : recorded_.estimate.front().resets;
    for (const record::EstimateRow& estimate : recorded_.estimate) {
      if (estimate.resets > resets) add(estimate.stamp_ns, "estimator", "estimate reset to the poses", true);
      resets = estimate.resets;
      if (estimate.pose_fault != fault && estimate.pose_fault > 0)
        add(estimate.stamp_ns, "estimator", "pose refused: " + name_of(kPoseFaults, estimate.pose_fault),
            true);
      fault = estimate.pose_fault;
    }
  }

 private:
  double time_at(std::int64_t stamp_ns) const {
    return static_cast<double>(stamp_ns - zero_ns_) / math::kNsPerS;
  }
  std::int64_t stamp_of(const record::RequestRow& request) const {
    return request.log_ns - recorded_.log_minus_stamp_ns;
  }
  void add(std::int64_t stamp_ns, const char* kind, std::string text, bool warning = false) {
    flight_.events.push_back({time_at(stamp_ns), kind, std::move(text), warning});
  }
  // A text that appears or changes.
  template <class Row>
  void add_sentences(const std::vector<Row>& rows, std::string Row::*text, const char* kind) {
    std::string last;
    for (const Row& row : rows) {
      if (row.*text != last && !(row.*text).empty()) add(row.stamp_ns, kind, row.*text, true);
      last = row.*text;
    }
  }

  const record::Flight& recorded_;
  const std::int64_t zero_ns_;
  FlightLog& flight_;
};

}  // namespace

void add_events(const record::Flight& recorded, const RecordedClock& clock, FlightLog& flight) {
  Events events(recorded, clock.zero_ns, flight);
  events.add_modes();
  events.add_mission();
  events.add_requests();
  events.add_faults();
  events.add_estimator();
  std::stable_sort(flight.events.begin(), flight.events.end(),
                   [](const FlightEvent& a, const FlightEvent& b) { return a.time_s < b.time_s; });
}

}  // namespace swiftlet::pages
