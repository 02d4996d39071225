// Tracking error of a flight: position of the ground truth minus position of the reference at the stamps of the reference.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "swiftlet/recording/flight_record.hpp"

namespace swiftlet::ground {

struct TrackingErrors {
  std::array<double, 3> rms_m{};   // north, east, down; all errors are NaN without a matched sample
  std::array<double, 3> peak_m{};  // largest absolute value
  double rms_3d_m = 0.0;
  double peak_3d_m = 0.0;
  std::size_t matched = 0;     // references inside the window whose truth is known
  double longest_gap_s = 0.0;  // between matched samples or a matched sample and an end of the window
};

// Where the truth of a reference comes from. Without a source the reference is not matched.
enum class TruthSource {
  kEqualStamps,  // a row of the same stamp
  kInterpolated,  // else from rows at most kLongestInterpolationS apart, with position and velocity: a network may lose rows
};
constexpr double kLongestInterpolationS = 0.05;  // at a snap of 1000 m/s^4 the error is below 20 um

// The truth of a stamp; nullopt if it is not known. Interpolated are the position by the cubic Hermite polynomial,
// all else linearly. after: the first row that is not older, or the end.
std::optional<TruthRow> truth_at(const Track<TruthRow>& truth, const TruthRow* after, std::int64_t stamp_ns,
                                 TruthSource source);

// The 3-D error of the newest of the last 64 references whose truth is known, m; NaN if there is none.
double newest_error_m(const Track<TruthRow>& truth, const Track<ReferenceRow>& reference);

// The rows of both tracks must be in ascending order of their stamps.
TrackingErrors tracking_errors(const Track<TruthRow>& truth, const Track<ReferenceRow>& reference,
                               Window window, TruthSource source = TruthSource::kEqualStamps);

// True if there are enough samples to evaluate the flight: at least a quarter of the number expected at rate_hz in
// the window, and no gap longer than kLongestGapS. In a longer gap a slow loop could diverge and return
// unnoticed. A network that loses half of all datagrams leaves 40 %.
constexpr double kTelemetryRateHz = 100.0;  // rate of reference telemetry
constexpr double kLeastMatchedFraction = 0.25;
constexpr double kLongestGapS = 0.25;
bool enough_samples(const TrackingErrors& errors, Window window, double rate_hz = kTelemetryRateHz);

}  // namespace swiftlet::ground
