// A flight of one vehicle as signals and events over time: what the page of flights shows.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace swiftlet::pages {

// Signals with the same times.
struct SignalTable {
  std::vector<double> time_s;                          // ascending
  std::map<std::string, std::vector<double>> signals;  // by name; NaN: no value
};

struct FlightEvent {
  double time_s = 0.0;
  std::string kind;  // "mode", "mission", "request", "fault", "vehicle", "estimator", "log"
  std::string text;
  bool warning = false;
};

struct ModeChange {
  double time_s = 0.0;
  std::string mode;
};

// Corners of a box, NED, m.
struct Fence {
  std::array<double, 3> min_ned{};
  std::array<double, 3> max_ned{};
};

// Times are 0 at the take-off, or at the start if there is none.
struct FlightLog {
  std::string name;        // of the file, with the vehicle if there are several
  std::string vehicle;     // "kl1"
  bool has_truth = false;  // the path is the ground truth, else the estimate
  double start_s = 0.0;
  double end_s = 0.0;
  double wall_start_s = 0.0;  // s since 1970 at time 0; 0 for simulated time
  // By the names that assets/flight_panels.js shows: path, reference, error, rates, ...
  std::map<std::string, SignalTable> tables;
  std::optional<Fence> fence;
  std::vector<ModeChange> modes;
  std::vector<FlightEvent> events;                           // ascending in time
  std::vector<std::pair<std::string, std::string>> summary;  // label and value
};

}  // namespace swiftlet::pages
