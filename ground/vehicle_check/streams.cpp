#include "swiftlet/ground/vehicle_check/streams.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/ground/vehicle_check/checks.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kSimulationSlip_s = 0.002;  // of a simulation that still keeps the clock
constexpr double kLeastOdometryRate_hz = 95.0;
constexpr double kImuRates[] = {500.0, 1000.0};
constexpr double kLeastOuterRate_hz = 100.0;  // of the IMU of a vehicle that closes the inner loops itself
constexpr double kOuterJitter = 50.0;         // likewise, %
constexpr double kEarliestPeriods = 2.0;      // of the IMU: if longer, a stamp may lie so far in the future

// A stream, the words of its checks, and the results of those that all streams share.
struct Stream {
  SampleTimes samples;
  SequenceCounts counts;
  Words words;
  CheckResults results;

  bool has_samples() const { return samples.size() >= kFewest; }
  void add(const Check& check, double value) { results.push_back(judge(check, value, words)); }
};

const char* reception_finding(const TopicState& state, std::size_t count) {
  if (!state.conflict.empty()) return "two processes publish {topic}: {conflict}";
  if (state.invalid > 0) return "{invalid:.0f} messages are invalid and not used by control: {fault}";
  if (count >= kFewest) return "";
  if (state.published)
    return "missing: {topic} is published, but {value:.0f} messages arrived in {duration:.1f} s";
  return "missing: nobody publishes {topic} here; look at the domain, the vehicle's name, the interface and "
         "the QoS";
}

CheckResult check_sequence(const SequenceCounts& counts, const Words& words) {
  const double lost = 1e2 * counts.lost_part();
  if (counts.repeated > 0)
    return judge_by(kSequence, lost,
                    "duplicate samples: {repeated:.0f} of {numbered:.0f} messages repeat the sequence number "
                    "of the one before",
                    words);
  if (counts.backward > 0)
    return judge_by(kSequence, lost, "the sequence number goes back {backward:.0f} times: it must count up",
                    words);
  return judge(kSequence, lost, words);
}

CheckResult check_stamps(const SequenceCounts& counts, const Words& words) {
  const auto faulty = static_cast<double>(counts.stamps_faulty());
  if (2 * counts.stamps_still > counts.pairs)
    return judge_by(kStamps, faulty, "frozen stamps: the stamp does not change from sample to sample", words);
  return judge(kStamps, faulty, words);
}

Stream stream_of(const char* topic, const TopicState& state, SampleTimes samples, double duration_s) {
  const SequenceCounts counts = count_sequence(samples);
  Stream stream{std::move(samples),
                counts,
                {{"topic", topic},
                 {"conflict", state.conflict},
                 {"invalid", state.invalid},
                 {"fault", state.fault},
                 {"duration", duration_s},
                 {"repeated", counts.repeated},
                 {"backward", counts.backward},
                 {"lost", counts.lost},
                 {"numbered", counts.pairs + 1},
                 {"sent", counts.lost + counts.pairs + 1},
                 {"still", counts.stamps_still},
                 {"back", counts.stamps_back}},
                {}};
  const std::size_t count = stream.samples.size();
  stream.results.push_back(
      judge_by(kReceived, static_cast<double>(count), reception_finding(state, count), stream.words));
  if (!stream.has_samples()) return stream;
  stream.results.push_back(check_sequence(counts, stream.words));
  stream.results.push_back(check_stamps(counts, stream.words));
  return stream;
}

bool is_simulated(const VehicleRecording& recording) {
  return recording.description && recording.description->simulated;
}

const Check& clock_check(const VehicleRecording& recording) {
  return is_simulated(recording) ? kSimulatedClock : kClock;
}

bool keeps_the_clock(double rate) { return rate >= kClock.least && rate <= kClock.most; }

// By the times of reception.
void check_rate_and_gap(Stream& stream, double least_rate_hz, double longest_gap_ms) {
  stream.add(with_limits(kRate, least_rate_hz, kUnlimited), rate_by_arrivals(stream.samples));
  stream.add(with_limits(kGap, 0.0, longest_gap_ms),
             1e3 * longest_interval_s(stream.samples, &SampleTime::received_ns));
}

// A vehicle that is never commanded at level actuators: control closes its outer loops only.
bool closes_inner_loops(const VehicleRecording& recording) {
  return recording.description && !recording.description->levels.has(plant::ControlLevel::kActuators);
}

CheckResult check_imu_rate(const VehicleRecording& recording, double rate_hz) {
  const bool declared = recording.description && recording.description->imu_rate_hz > 0.0;
  const double nearest_hz =
      std::abs(std::log(rate_hz / kImuRates[0])) < std::abs(std::log(rate_hz / kImuRates[1])) ? kImuRates[0]
                                                                                              : kImuRates[1];
  const double expected_hz = declared ? recording.description->imu_rate_hz : nearest_hz;
  const Words words = {{"expected", expected_hz}, {"of", declared ? "declared" : "required"}};
  const bool is_outer = closes_inner_loops(recording);
  const bool is_allowed = is_outer ? expected_hz >= kLeastOuterRate_hz
                                   : std::count(std::begin(kImuRates), std::end(kImuRates), expected_hz) > 0;
  if (!is_allowed)
    return judge_by(kImuRate, rate_hz,
                    std::string("vehicle_info declares {expected:g} Hz: the controller needs ") +
                        (is_outer ? "100 Hz or more" : "500 or 1000 Hz"),
                    words);
  const double part = rate_hz / expected_hz;
  if (part + 0.5 >= kImuRate.least && part + 0.5 <= kImuRate.most)
    return judge_by(kImuRate, rate_hz, "half the {of} rate: {value:.0f} Hz instead of {expected:.0f} Hz",
                    words);
  return judge(with_limits(kImuRate, kImuRate.least * expected_hz, kImuRate.most * expected_hz), rate_hz,
               words);
}

// Vehicle's clock minus computer's clock, from the exchange with the shortest way.
struct ClockOffset {
  std::int64_t offset_ns = 0;
  double uncertainty_ms = 0.0;
};
std::optional<ClockOffset> clock_offset(const std::vector<ClockExchange>& exchanges) {
  const auto way_ns = [](const ClockExchange& it) {
    return (it.returned_ns - it.sent_ns) - (it.answered_ns - it.received_ns);
  };
  const auto best = std::min_element(exchanges.begin(), exchanges.end(),
                                     [&](const auto& a, const auto& b) { return way_ns(a) < way_ns(b); });
  if (best == exchanges.end()) return std::nullopt;
  return ClockOffset{((best->received_ns - best->sent_ns) + (best->answered_ns - best->returned_ns)) / 2,
                     0.5e-6 * static_cast<double>(way_ns(*best))};
}

CheckResult check_imu_age(const VehicleRecording& recording, const SampleTimes& samples) {
  const std::optional<ClockOffset> offset = clock_offset(recording.clock);
  if (!offset)
    return skipped(kImuAge.name, "no answer to clock_request; --hand measures the delay to motion capture");
  std::vector<double> ages;
  for (const SampleTime& sample : samples)
    ages.push_back(1e-9 * static_cast<double>(sample.received_ns + offset->offset_ns - sample.stamp_ns));
  const double age_ms = 1e3 * quantile(std::move(ages), 0.5);
  return judge(
      with_limits(kImuAge, kImuAge.least - offset->uncertainty_ms, kImuAge.most + offset->uncertainty_ms),
      age_ms);
}

// Age of the samples when they arrive, by the stamp of the newest IMU sample.
CheckResult check_age(const StreamLimits& limits, const SampleTimes& samples, const SampleTimes& imu) {
  std::vector<double> ages;
  std::size_t next = 0;
  for (const SampleTime& sample : samples) {
    while (next < imu.size() && imu[next].received_ns <= sample.received_ns) ++next;
    if (next > 0) ages.push_back(1e-9 * static_cast<double>(imu[next - 1].stamp_ns - sample.stamp_ns));
  }
  if (ages.empty()) return skipped(limits.topic + std::string(".age"), "no IMU sample arrived before");
  const double earliest_ms = imu.size() < kFewest
                                 ? kAge.least
                                 : std::min(kAge.least, -1e3 * kEarliestPeriods / rate_by_arrivals(imu));
  return judge(with_limits(kAge, earliest_ms, limits.oldest_ms), 1e3 * quantile(std::move(ages), 0.5),
               {{"topic", limits.topic}});
}

}  // namespace

CheckResults check_stream(const StreamLimits& limits, const TopicState& state, const SampleTimes& samples,
                          const VehicleRecording& recording) {
  if (limits.absent != nullptr && !state.published && samples.empty())
    return {skipped(limits.topic + std::string(".received"), limits.absent)};
  Stream stream = stream_of(limits.topic, state, samples, recording.duration_s());
  if (!stream.has_samples()) return stream.results;
  check_rate_and_gap(stream, limits.least_rate_hz, limits.longest_gap_ms);
  const SampleTimes imu = times_of(recording.imu);
  stream.results.push_back(
      check_age(limits, stream.samples, imu.empty() ? times_of(recording.odometry) : imu));
  return stream.results;
}

double vehicle_rate(const VehicleRecording& recording) {
  if (!is_simulated(recording)) return 1.0;
  const double rate = clock_rate(times_of(recording.imu));
  const bool is_scaled =
      rate >= kSimulatedClock.least && rate <= kSimulatedClock.most && !keeps_the_clock(rate);
  return is_scaled ? rate : 1.0;
}

CheckResults check_imu_stream(const VehicleRecording& recording) {
  Stream stream = stream_of("imu", recording.imu, times_of(recording.imu), recording.duration_s());
  if (!stream.has_samples()) return stream.results;
  const SampleTimes& samples = stream.samples;
  CheckResults& results = stream.results;
  const double clock = clock_rate(samples);
  stream.add(clock_check(recording), clock);
  const bool stamps_count = results.back().verdict == Verdict::kPass && stream.counts.stamps_faulty() == 0;
  const bool keeps_clock = stamps_count && keeps_the_clock(clock) &&
                           (!is_simulated(recording) || clock_slip_s(samples) <= kSimulationSlip_s);
  results.push_back(
      check_imu_rate(recording, stamps_count ? rate_by_stamps(samples) : rate_by_arrivals(samples)));
  const double gap_s =
      longest_interval_s(samples, stamps_count ? &SampleTime::stamp_ns : &SampleTime::received_ns);
  stream.add(kGap, 1e3 * gap_s);
  const double most_jitter = closes_inner_loops(recording) ? kOuterJitter : kJitter.most;
  const double jitter = 1e2 * stamp_jitter_p99(samples);
  results.push_back(!stamps_count            ? skipped(kJitter.name, "the stamps do not follow the clock")
                    : !std::isfinite(jitter) ? skipped(kJitter.name, "no two samples follow each other")
                                             : judge(with_limits(kJitter, 0.0, most_jitter), jitter));
  if (keeps_clock) {
    stream.add(kDelivery, 1e3 * delivery_delay_p99_s(samples));
    results.push_back(check_imu_age(recording, samples));
  } else {
    for (const Check& check : {kDelivery, kImuAge})
      results.push_back(skipped(check.name, "the stamps do not follow the computer's clock"));
  }
  return results;
}

CheckResults check_odometry_stream(const VehicleRecording& recording) {
  Stream stream =
      stream_of("vehicle_odometry", recording.odometry, times_of(recording.odometry), recording.duration_s());
  if (!stream.has_samples()) return stream.results;
  stream.add(clock_check(recording), clock_rate(stream.samples));
  check_rate_and_gap(stream, kLeastOdometryRate_hz, kGap.most);
  return stream.results;
}

}  // namespace swiftlet::ground
