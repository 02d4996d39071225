// How well a flight followed its reference: the truth less the reference at equal stamps.
#pragma once

#include <array>
#include <cstddef>

#include "swiftlet/recording/flight_record.hpp"

namespace swiftlet::ground {

struct TrackingErrors {
  std::array<double, 3> rms_m{};   // north, east, down; NaN without a matched sample
  std::array<double, 3> peak_m{};  // of the absolute value
  double rms_3d_m = 0.0;
  double peak_3d_m = 0.0;
  std::size_t matched = 0;     // samples of truth and reference with one stamp inside the window
  double longest_gap_s = 0.0;  // between matched samples, the window's ends included
};

// Rows of both tracks are in the order of their stamps.
TrackingErrors tracking_errors(const Track<TruthRow>& truth, const Track<ReferenceRow>& reference,
                               Window window);

// Enough samples to judge the flight by: half of those that rate_hz makes in the window, and never none for
// longer than kLongestGapS, in which a slow loop could go astray and come back.
constexpr double kTelemetryRateHz = 100.0;  // of references
constexpr double kLeastMatchedFraction = 0.5;
constexpr double kLongestGapS = 0.25;
bool enough_samples(const TrackingErrors& errors, Window window, double rate_hz = kTelemetryRateHz);

}  // namespace swiftlet::ground
