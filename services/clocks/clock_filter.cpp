#include "swiftlet/services/clocks/clock_filter.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::clocks {
namespace {

// Standard deviation of the drift before anything is measured: crystals are within 100 ppm.
constexpr double kPriorDrift = 100e-6;
// Least standard deviation of an offset: stamps are taken by programs.
constexpr double kStampNoiseNs = 5e3;
// The spread of this many shortest round trips shows how much the shortest may still exceed the time on the way.
constexpr std::size_t kShortest = 5;
// Change of the drift while nothing is measured, s/s: by temperature.
constexpr double kDriftWander = 1e-6;
// Smallest step that is recognised, beyond what the round trips leave open.
constexpr double kStepNs = 1e6;
// Residuals beyond this many standard deviations count less (Huber).
constexpr double kHuber = 1.5;
constexpr int kIterations = 5;

}  // namespace

std::int64_t ClockEstimate::offset_at(std::int64_t now_ns) const {
  return offset_ns + std::llround(drift * static_cast<double>(now_ns - measured_ns));
}

double ClockEstimate::uncertainty_ns(std::int64_t now_ns) const {
  const double age_ns = std::abs(static_cast<double>(now_ns - measured_ns));
  const double drifted_ns = (drift_deviation + kDriftWander) * age_ns;
  return half_round_trip_ns + 2.0 * std::hypot(offset_deviation_ns, drifted_ns);
}

const char* ClockFilter::add(const ClockExchange& exchange) {
  if (const char* const fault = fault_of(exchange)) return fault;
  const Measurement measurement{measured_ns(exchange), offset_ns(exchange),
                                static_cast<double>(round_trip_ns(exchange))};
  const bool is_doubtful = contradicts(measurement);
  if (has_asked_ && exchange.asked_ns <= last_asked_ns_ && !is_doubtful)
    return "a later question was answered before";
  has_asked_ = true;
  last_asked_ns_ = exchange.asked_ns;
  if (is_doubtful) {
    doubt(measurement);
  } else {
    doubts_ = 0;
    keep(measurement);
    estimate_ = fit();
  }
  return nullptr;
}

// The offset of an exchange is wrong by at most half of its round trip.
bool ClockFilter::contradicts(const Measurement& measurement) const {
  if (!estimate_) return false;
  const double difference_ns =
      static_cast<double>(measurement.offset_ns - estimate_->offset_at(measurement.at_ns));
  return std::abs(difference_ns) >
         0.5 * measurement.round_trip_ns + estimate_->uncertainty_ns(measurement.at_ns) + kStepNs;
}

// Begins again with exchanges that contradict the estimate and agree with each other.
void ClockFilter::doubt(const Measurement& measurement) {
  if (doubts_ > 0) {
    const Measurement& last = doubted_[doubts_ - 1];
    const double difference_ns = static_cast<double>(measurement.offset_ns - last.offset_ns);
    const double drifted_ns = kPriorDrift * static_cast<double>(measurement.at_ns - last.at_ns);
    const double open_ns = 0.5 * (measurement.round_trip_ns + last.round_trip_ns) + drifted_ns + kStepNs;
    if (std::abs(difference_ns) > open_ns) doubts_ = 0;
  }
  doubted_[doubts_++] = measurement;
  if (doubts_ < kStepExchanges) return;
  size_ = 0;
  next_ = 0;
  for (const Measurement& it : doubted_) keep(it);
  doubts_ = 0;
  ++steps_;
  estimate_ = fit();
}

void ClockFilter::keep(const Measurement& measurement) {
  window_[next_] = measurement;
  next_ = (next_ + 1) % kWindow;
  size_ = std::min(size_ + 1, kWindow);
}

// The shortest round trip, and the uncertainty of its offset: half of the spread of the shortest ones.
ClockFilter::RoundTrips ClockFilter::round_trips() const {
  std::array<double, kWindow> sorted{};
  for (std::size_t i = 0; i < size_; ++i) sorted[i] = window_[i].round_trip_ns;
  std::sort(sorted.begin(), sorted.begin() + size_);
  const double spread_ns = size_ < 2 * kShortest ? sorted[0] : sorted[kShortest - 1] - sorted[0];
  return {sorted[0], std::max(kStampNoiseNs, 0.5 * spread_ns)};
}

// Iteratively reweighted least squares for offset = a + b t, t from the newest exchange on, with the prior of the
// drift b. An exchange deviates by half of what its round trip exceeds the shortest, and by what the shortest deviates.
ClockEstimate ClockFilter::fit() const {
  const Measurement& newest = window_[(next_ + kWindow - 1) % kWindow];
  const RoundTrips trips = round_trips();

  double a = 0.0, b = 0.0, var_a = 0.0, var_b = 0.0, chi_squared = 0.0, mean_round_trip_ns = 0.0;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    double s = 0.0, st = 0.0, stt = 1.0 / (kPriorDrift * kPriorDrift), sy = 0.0, sty = 0.0, sd = 0.0;
    chi_squared = 0.0;
    for (std::size_t i = 0; i < size_; ++i) {
      const double t = static_cast<double>(window_[i].at_ns - newest.at_ns);
      const double y = static_cast<double>(window_[i].offset_ns - newest.offset_ns);
      const double deviation = trips.deviation_ns + 0.5 * (window_[i].round_trip_ns - trips.shortest_ns);
      const double residual = iteration == 0 ? 0.0 : std::abs(y - a - b * t) / deviation;
      const double huber = residual > kHuber ? kHuber / residual : 1.0;
      const double weight = huber / (deviation * deviation);
      chi_squared += huber * residual * residual;
      s += weight;
      st += weight * t;
      stt += weight * t * t;
      sy += weight * y;
      sty += weight * t * y;
      sd += weight * window_[i].round_trip_ns;
    }
    const double determinant = s * stt - st * st;
    a = (stt * sy - st * sty) / determinant;
    b = (s * sty - st * sy) / determinant;
    var_a = stt / determinant;
    var_b = s / determinant;
    mean_round_trip_ns = sd / s;
  }
  // Where the exchanges scatter more than assumed, so does the line.
  const double scatter =
      size_ > 2 ? std::max(1.0, std::sqrt(chi_squared / static_cast<double>(size_ - 2))) : 1.0;

  ClockEstimate estimate;
  estimate.measured_ns = newest.at_ns;
  estimate.offset_ns = newest.offset_ns + std::llround(a);
  estimate.drift = b;
  estimate.drift_deviation = scatter * std::sqrt(var_b);
  estimate.half_round_trip_ns = 0.5 * mean_round_trip_ns;
  estimate.offset_deviation_ns = scatter * std::sqrt(var_a);
  return estimate;
}

}  // namespace swiftlet::clocks
