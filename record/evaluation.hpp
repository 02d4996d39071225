// The result of a flight, from what was recorded of it: the mission that was flown, how long it took, and how far the vehicle was
// from its reference.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/record/flight.hpp"

namespace swiftlet::record {

// Half-open interval of stamps [from_ns, to_ns).
struct Window {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;

  double duration_s() const { return static_cast<double>(to_ns - from_ns) * 1e-9; }
};

// By what a flight is judged: the best that is known of where the vehicle was.
enum class Against : std::uint8_t { kGroundTruth, kMotionCapture, kEstimate };
const char* to_string(Against against);  // "ground truth"

// Position of the vehicle minus position of the reference, at the stamps of the reference.
struct TrackingErrors {
  Against against = Against::kGroundTruth;
  std::array<double, 3> rms_m{};   // north, east, down; all errors are NaN without a matched sample
  std::array<double, 3> peak_m{};  // largest absolute value
  double rms_3d_m = 0.0;
  double peak_3d_m = 0.0;
  std::size_t matched = 0;     // references inside the window at whose stamps the position is known
  double longest_gap_s = 0.0;  // between matched samples or a matched sample and an end of the window
};

// The motion at a stamp: the row of this stamp, or interpolated between rows at most kLongestInterpolationS apart, since a network
// may lose rows: the position by the cubic Hermite polynomial, all else linearly. nullopt if it is not known. after: the first
// row that is not older, or the end. Row: TruthRow or EstimateRow, of which position, velocity, attitude and rates are
// interpolated, the rest is that of the earlier row.
constexpr double kLongestInterpolationS = 0.05;  // at a snap of 1000 m/s^4 the error is below 20 um
template <class Row>
std::optional<Row> motion_at(const std::vector<Row>& rows, typename std::vector<Row>::const_iterator after,
                             std::int64_t stamp_ns);

template <class Row>
TrackingErrors tracking_errors(const std::vector<Row>& flown, const std::vector<ReferenceRow>& reference,
                               Window window);
// The errors of a flight in this window are against the ground truth, for a real vehicle against the poses of motion capture, without
// these against the estimate.
TrackingErrors tracking_errors(const Flight& flight, Window window);

// True if there are enough samples to evaluate the flight: at least a quarter of the number expected at rate_hz in
// the window, and no gap longer than kLongestGapS. In a longer gap a slow loop could diverge and return
// unnoticed. A network that loses half of all datagrams leaves 40 %.
constexpr double kTelemetryRateHz = 100.0;  // rate of reference telemetry
constexpr double kLeastMatchedFraction = 0.25;
constexpr double kLongestGapS = 0.25;
bool enough_samples(const TrackingErrors& errors, Window window, double rate_hz = kTelemetryRateHz);

struct Evaluation {
  // In which errors are evaluated: of a mission from its start to the start of its landing, or to its end if it has none; without
  // a mission from the first reference in the air to the first of a landing. nullopt: nothing was flown.
  std::optional<Window> window;
  std::uint64_t mission_id = 0;  // the first that was flown; 0: none
  bool completed = false;        // the mission
  std::string reason;            // why it was not completed, as its last status says
  double duration_s = 0.0;       // from its start to its end, or to that of the record
  TrackingErrors errors;
};
Evaluation evaluate(const Flight& flight);

// The stamps of the last item of each mission that ended with its landing: the ground stops the vehicle short of its reference
// there.
std::vector<Window> landing_items(const Flight& flight);

}  // namespace swiftlet::record
