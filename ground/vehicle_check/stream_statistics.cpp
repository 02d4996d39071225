#include "swiftlet/ground/vehicle_check/stream_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "swiftlet/math/time.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kWindows = 10;  // of clock_rate()

struct Point {
  double x = 0.0;
  double y = 0.0;
};

double slope_of(const std::vector<Point>& points) {
  Point mean;
  for (const Point& point : points) {
    mean.x += point.x / static_cast<double>(points.size());
    mean.y += point.y / static_cast<double>(points.size());
  }
  double covariance = 0.0;
  double variance = 0.0;
  for (const Point& point : points) {
    covariance += (point.x - mean.x) * (point.y - mean.y);
    variance += (point.x - mean.x) * (point.x - mean.x);
  }
  return variance > 0.0 ? covariance / variance : kNaN;
}

}  // namespace

double SequenceCounts::lost_part() const {
  const double received = static_cast<double>(pairs - repeated - backward) + 1.0;
  return static_cast<double>(lost) / (static_cast<double>(lost) + received);
}

SequenceCounts count_sequence(const SampleTimes& samples) {
  SequenceCounts counts;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const SampleTime& before = samples[i - 1];
    const SampleTime& now = samples[i];
    ++counts.pairs;
    if (now.sequence == before.sequence) {
      ++counts.repeated;
    } else if (now.sequence < before.sequence) {
      ++counts.backward;
    } else {
      counts.lost += now.sequence - before.sequence - 1;
      counts.stamps_still += now.stamp_ns == before.stamp_ns ? 1 : 0;
      counts.stamps_back += now.stamp_ns < before.stamp_ns ? 1 : 0;
    }
  }
  return counts;
}

double clock_rate(const SampleTimes& samples) {
  if (samples.size() < 3) return kNaN;
  const SampleTime& first = samples.front();
  const auto delay_ns = [&](const SampleTime& sample) {
    return (sample.received_ns - first.received_ns) - (sample.stamp_ns - first.stamp_ns);
  };
  const std::int64_t span_ns = samples.back().received_ns - first.received_ns + 1;
  std::vector<Point> earliest;
  std::optional<SampleTime> best;
  std::int64_t window = 0;
  const auto close = [&] {
    if (best)
      earliest.push_back({math::seconds(best->received_ns - first.received_ns),
                          math::seconds(best->stamp_ns - first.stamp_ns)});
    best.reset();
  };
  for (const SampleTime& sample : samples) {
    const std::int64_t at =
        (sample.received_ns - first.received_ns) * static_cast<std::int64_t>(kWindows) / span_ns;
    if (at != window) close();
    window = at;
    if (!best || delay_ns(sample) < delay_ns(*best)) best = sample;
  }
  close();
  return slope_of(earliest);
}

double rate_by_stamps(const SampleTimes& samples) {
  std::vector<std::int64_t> stamps;
  stamps.reserve(samples.size());
  for (const SampleTime& sample : samples) stamps.push_back(sample.stamp_ns);
  std::sort(stamps.begin(), stamps.end());
  stamps.erase(std::unique(stamps.begin(), stamps.end()), stamps.end());
  if (stamps.size() < 3) return kNaN;
  return static_cast<double>(stamps.size() - 1) / math::seconds(stamps.back() - stamps.front());
}

double rate_by_arrivals(const SampleTimes& samples) {
  if (samples.size() < 3) return kNaN;
  return static_cast<double>(samples.size() - 1) /
         math::seconds(samples.back().received_ns - samples.front().received_ns);
}

double longest_interval_s(const SampleTimes& samples, std::int64_t SampleTime::*time) {
  std::int64_t longest_ns = 0;
  for (std::size_t i = 1; i < samples.size(); ++i)
    longest_ns = std::max(longest_ns, samples[i].*time - samples[i - 1].*time);
  return math::seconds(longest_ns);
}

double stamp_jitter_p99(const SampleTimes& samples) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].sequence == samples[i - 1].sequence + 1)
      intervals.push_back(math::seconds(samples[i].stamp_ns - samples[i - 1].stamp_ns));
  }
  const double median = quantile(intervals, 0.5);
  for (double& interval : intervals) interval = std::abs(interval - median) / median;
  return quantile(std::move(intervals), 0.99);
}

double delivery_delay_p99_s(const SampleTimes& samples) {
  std::vector<double> delays;
  delays.reserve(samples.size());
  for (const SampleTime& sample : samples)
    delays.push_back(math::seconds(sample.received_ns - sample.stamp_ns));
  if (delays.empty()) return kNaN;
  const double least = *std::min_element(delays.begin(), delays.end());
  return quantile(std::move(delays), 0.99) - least;
}

double clock_slip_s(const SampleTimes& samples) {
  const auto least_delay_ns = [&](std::size_t begin, std::size_t end) {
    std::int64_t least_ns = std::numeric_limits<std::int64_t>::max();
    for (; begin < end; ++begin)
      least_ns = std::min(least_ns, samples[begin].received_ns - samples[begin].stamp_ns);
    return least_ns;
  };
  const std::size_t count = samples.size();
  if (count == 0) return kNaN;
  const std::int64_t fastest_ns = least_delay_ns(0, count);
  const std::int64_t first_ns = least_delay_ns(0, (count + 9) / 10);
  const std::int64_t last_ns = least_delay_ns(count - (count + 99) / 100, count);
  return math::seconds(std::max(first_ns, last_ns) - fastest_ns);
}

double quantile(std::vector<double> numbers, double part) {
  if (numbers.empty()) return kNaN;
  const auto at = static_cast<std::size_t>(part * static_cast<double>(numbers.size() - 1) + 0.5);
  std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(at), numbers.end());
  return numbers[at];
}

}  // namespace swiftlet::ground
