#include "swiftlet/ground/vehicle_check/streams.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/core.h>

#include "swiftlet/ground/vehicle_check/stream_statistics.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kClockTolerance = 0.05;     // of the rate of the stamps
constexpr double kSlowestSimulation = 0.01;  // speeds of a simulated vehicle
constexpr double kFastestSimulation = 100.0;
constexpr double kSimulationSlip_s = 0.002;  // of a simulation that still keeps the clock
constexpr double kRateTolerance = 0.05;
constexpr double kLeastOdometryRate_hz = 95.0;
constexpr double kImuRates[] = {500.0, 1000.0};
constexpr double kLeastOuterRate_hz = 100.0;  // of the IMU of a vehicle that closes the inner loops itself
constexpr double kMostLost = 0.05;
constexpr double kImuGap_s = 0.1;      // imu_timeout_s of the control settings
constexpr double kStampJitter = 0.25;  // of the period
constexpr double kOuterStampJitter = 0.5;
constexpr double kDeliveryDelay_s = 0.02;
constexpr double kImuAge_s = 0.05;     // the loop becomes unstable at such delays
constexpr double kEarliest_s = 0.005;  // a stamp may lie this much in the future
constexpr double kEarliest = 2.0;      // or so many periods of the IMU, if they are longer

struct StreamLimits {
  const char* topic;
  double least_rate_hz;
  double longest_gap_s;
  double oldest_s;  // age of a stamp when it arrives
};
constexpr StreamLimits kBatteryLimits{"battery", 5.0, 1.0, 0.5};
constexpr StreamLimits kMocapLimits{"mocap_pose", 30.0, 0.2, 0.1};
constexpr StreamLimits kRotorSpeedLimits{"rotor_speeds", 50.0, 0.1, 0.1};

std::string check_name(const std::string& topic, const char* subject) { return topic + "." + subject; }

template <class Sample>
CheckResult check_received(const std::string& topic, const TopicRecord<Sample>& record, double duration_s) {
  const std::string name = check_name(topic, "received");
  const std::size_t count = record.samples.size();
  std::string finding;
  if (!record.conflict.empty()) {
    finding = "two processes publish " + topic + ": " + record.conflict;
  } else if (record.invalid > 0) {
    finding =
        fmt::format("{} messages are invalid and not used by control: {}", record.invalid, record.fault);
  } else if (count < kFewest && !record.published) {
    finding = fmt::format(
        "missing: nobody publishes {} here; look at the domain, the vehicle's name, the interface and the "
        "QoS",
        topic);
  } else if (count < kFewest) {
    finding = fmt::format("missing: {} is published, but {} messages arrived in {:.1f} s", topic, count,
                          duration_s);
  }
  return judged(name, figure(static_cast<double>(count), "messages", 0), "valid, of one process", finding);
}

CheckResult check_sequence(const std::string& topic, const SequenceCounts& counts) {
  const double lost = counts.lost_part();
  std::string finding;
  if (counts.repeated > 0) {
    finding = fmt::format("duplicate samples: {} of {} messages repeat the sequence number of the one before",
                          counts.repeated, counts.pairs + 1);
  } else if (counts.backward > 0) {
    finding = fmt::format("the sequence number goes back {} times: it must count up", counts.backward);
  } else if (lost > kMostLost) {
    finding = fmt::format("gaps: {} of {} samples did not arrive, by their sequence numbers", counts.lost,
                          counts.lost + counts.pairs + 1);
  }
  return judged(check_name(topic, "sequence"),
                figure(1e2 * lost, "%", 1, fmt::format(" lost, {} repeated", counts.repeated)),
                fmt::format("lost at most {:.0f} %, none repeated", 1e2 * kMostLost), finding);
}

CheckResult check_stamps(const std::string& topic, const SequenceCounts& counts) {
  const std::size_t faulty = counts.stamps_still + counts.stamps_back;
  std::string finding;
  if (2 * counts.stamps_still > counts.pairs) {
    finding = "frozen stamps: the stamp does not change from sample to sample";
  } else if (faulty > 0) {
    finding = fmt::format(
        "{} stamps repeat and {} lie before that of the sample before: control does not use these samples",
        counts.stamps_still, counts.stamps_back);
  }
  return judged(check_name(topic, "stamps"), figure(static_cast<double>(faulty), "", 0, " not rising"),
                "all rise", finding);
}

std::string clock_finding(double rate, bool simulated) {
  const auto is_near = [&](double value) { return std::abs(rate / value - 1.0) < 0.5; };
  if (simulated && rate >= kSlowestSimulation && rate <= kFastestSimulation) return "";
  if (std::abs(rate - 1.0) <= kClockTolerance) return "";
  if (rate == 0.0) return "frozen stamps: they do not follow the clock";
  if (is_near(1e-3)) return "stamps in us: stamp_ns must count nanoseconds";
  if (is_near(1e-6)) return "stamps in ms: stamp_ns must count nanoseconds";
  if (is_near(1e-9)) return "stamps in s: stamp_ns must count nanoseconds";
  return "the stamps do not run with the clock: they are not those of a clock in ns";
}

CheckResult check_clock(const std::string& topic, double rate, bool simulated) {
  const std::string limit =
      simulated ? fmt::format("{:g} to {:g}, simulated", kSlowestSimulation, kFastestSimulation)
                : fmt::format("1 +- {:.0f} %", 1e2 * kClockTolerance);
  Figure measured{rate, "s/s", fmt::format("{:.5g} s/s", rate)};
  return judged(check_name(topic, "clock"), std::move(measured), limit, clock_finding(rate, simulated));
}

// A vehicle that is never commanded at level actuators: control closes its outer loops only.
bool closes_inner_loops(const VehicleRecording& recording) {
  return recording.description && !recording.description->levels.has(plant::ControlLevel::kActuators);
}

std::string imu_rate_finding(double rate_hz, double expected_hz, bool declared, bool is_outer) {
  const bool is_allowed = std::any_of(std::begin(kImuRates), std::end(kImuRates),
                                      [&](double allowed) { return expected_hz == allowed; });
  if (is_outer && expected_hz < kLeastOuterRate_hz)
    return fmt::format("vehicle_info declares {:g} Hz: the controller needs 100 Hz or more", expected_hz);
  if (!is_outer && !is_allowed)
    return fmt::format("vehicle_info declares {:g} Hz: the controller needs 500 or 1000 Hz", expected_hz);
  if (std::abs(rate_hz / expected_hz - 1.0) <= kRateTolerance) return "";
  const char* const of = declared ? "declared" : "required";
  if (std::abs(rate_hz / expected_hz - 0.5) <= kRateTolerance)
    return fmt::format("half the {} rate: {:.0f} Hz instead of {:.0f} Hz", of, rate_hz, expected_hz);
  return fmt::format("the rate is {:.0f} Hz instead of the {} {:.0f} Hz", rate_hz, of, expected_hz);
}

CheckResult check_imu_rate(const VehicleRecording& recording, double rate_hz) {
  const bool declared = recording.description && recording.description->imu_rate_hz > 0.0;
  const double nearest_hz =
      std::abs(std::log(rate_hz / kImuRates[0])) < std::abs(std::log(rate_hz / kImuRates[1])) ? kImuRates[0]
                                                                                              : kImuRates[1];
  const double expected_hz = declared ? recording.description->imu_rate_hz : nearest_hz;
  return judged("imu.rate", figure(rate_hz, "Hz", 1),
                fmt::format("{:g} Hz +- {:.0f} %", expected_hz, 1e2 * kRateTolerance),
                imu_rate_finding(rate_hz, expected_hz, declared, closes_inner_loops(recording)));
}

CheckResult check_gap(const std::string& topic, double gap_s, double limit_s) {
  return judged(check_name(topic, "gap"), figure(1e3 * gap_s, "ms", 1),
                fmt::format("at most {:.0f} ms", 1e3 * limit_s),
                gap_s <= limit_s ? "" : fmt::format("gaps: no sample for {:.0f} ms", 1e3 * gap_s));
}

CheckResult check_stamp_jitter(double jitter, double limit) {
  return judged("imu.jitter", figure(1e2 * jitter, "%", 1, " of the period, p99"),
                fmt::format("at most {:.0f} %", 1e2 * limit),
                jitter <= limit ? ""
                                : "the stamps are irregular: they are not taken when the sensor "
                                  "measures, or the sampling is not steady");
}

CheckResult check_delivery(double delay_s) {
  return judged(
      "imu.delivery", figure(1e3 * delay_s, "ms", 1, " later than the fastest, p99"),
      fmt::format("at most {:.0f} ms", 1e3 * kDeliveryDelay_s),
      delay_s <= kDeliveryDelay_s
          ? ""
          : "samples are delivered in bursts or late: the link or the vehicle's loop does not keep time");
}

// Vehicle's clock minus computer's clock, from the exchange with the shortest way.
struct ClockOffset {
  std::int64_t offset_ns = 0;
  double uncertainty_s = 0.0;
};
std::optional<ClockOffset> clock_offset(const std::vector<ClockExchange>& exchanges) {
  const auto way_ns = [](const ClockExchange& it) {
    return (it.returned_ns - it.sent_ns) - (it.answered_ns - it.received_ns);
  };
  const auto best = std::min_element(exchanges.begin(), exchanges.end(),
                                     [&](const auto& a, const auto& b) { return way_ns(a) < way_ns(b); });
  if (best == exchanges.end()) return std::nullopt;
  return ClockOffset{((best->received_ns - best->sent_ns) + (best->answered_ns - best->returned_ns)) / 2,
                     0.5e-9 * static_cast<double>(way_ns(*best))};
}

std::string age_finding(double age_s, double oldest_s, double earliest_s) {
  if (age_s > oldest_s)
    return fmt::format("late stamps: a sample is {:.0f} ms old by its stamp when it arrives", 1e3 * age_s);
  if (age_s < -earliest_s)
    return fmt::format("the stamps lie {:.0f} ms in the future of the vehicle's clock", -1e3 * age_s);
  return "";
}

std::string age_limit(double oldest_s, double earliest_s) {
  return fmt::format("{:.0f} to {:.0f} ms", -1e3 * earliest_s, 1e3 * oldest_s);
}

CheckResult check_imu_age(const VehicleRecording& recording, const SampleTimes& samples, bool keeps_clock) {
  if (!keeps_clock) return skipped("imu.age", "the stamps do not follow the computer's clock");
  const std::optional<ClockOffset> offset = clock_offset(recording.clock);
  if (!offset)
    return skipped("imu.age", "no answer to clock_request; --hand measures the delay to motion capture");
  std::vector<double> ages;
  for (const SampleTime& sample : samples)
    ages.push_back(1e-9 * static_cast<double>(sample.received_ns + offset->offset_ns - sample.stamp_ns));
  const double age_s = quantile(std::move(ages), 0.5);
  const double earliest_s = kEarliest_s + offset->uncertainty_s;
  return judged("imu.age", figure(1e3 * age_s, "ms", 1, " by the vehicle's clock"),
                age_limit(kImuAge_s, earliest_s),
                age_finding(age_s, kImuAge_s + offset->uncertainty_s, earliest_s));
}

// Age of the samples when they arrive, by the stamp of the newest IMU sample.
CheckResult check_age(const StreamLimits& limits, const SampleTimes& samples, const SampleTimes& imu) {
  const std::string name = check_name(limits.topic, "age");
  std::vector<double> ages;
  std::size_t next = 0;
  for (const SampleTime& sample : samples) {
    while (next < imu.size() && imu[next].received_ns <= sample.received_ns) ++next;
    if (next > 0) ages.push_back(1e-9 * static_cast<double>(imu[next - 1].stamp_ns - sample.stamp_ns));
  }
  if (ages.empty()) return skipped(name, "no IMU sample arrived before");
  const double age_s = quantile(std::move(ages), 0.5);
  const double earliest_s =
      imu.size() < kFewest ? kEarliest_s : std::max(kEarliest_s, kEarliest / rate_by_arrivals(imu));
  std::string finding = age_finding(age_s, limits.oldest_s, earliest_s);
  if (std::abs(age_s) > 10.0) finding = "the stamps are not those of the vehicle's clock in ns, as in imu";
  return judged(name, figure(1e3 * age_s, "ms", 1, " behind imu"), age_limit(limits.oldest_s, earliest_s),
                finding);
}

template <class Sample>
CheckResults check_stream(const StreamLimits& limits, const TopicRecord<Sample>& record,
                          const VehicleRecording& recording) {
  CheckResults results = {check_received(limits.topic, record, recording.duration_s())};
  const SampleTimes samples = times_of(record);
  if (samples.size() < kFewest) return results;
  const SequenceCounts counts = count_sequence(samples);
  results.push_back(check_sequence(limits.topic, counts));
  results.push_back(check_stamps(limits.topic, counts));
  const double rate_hz = rate_by_arrivals(samples);
  results.push_back(
      judged(check_name(limits.topic, "rate"), figure(rate_hz, "Hz", 1),
             fmt::format("at least {:g} Hz", limits.least_rate_hz),
             rate_hz >= limits.least_rate_hz ? "" : fmt::format("too slow: {:.1f} Hz", rate_hz)));
  results.push_back(check_gap(limits.topic, longest_interval_by_arrivals_s(samples), limits.longest_gap_s));
  const SampleTimes imu = times_of(recording.imu);
  results.push_back(check_age(limits, samples, imu.empty() ? times_of(recording.odometry) : imu));
  return results;
}

}  // namespace

double vehicle_rate(const VehicleRecording& recording) {
  if (!recording.description || !recording.description->simulated) return 1.0;
  const double rate = clock_rate(times_of(recording.imu));
  const bool is_scaled =
      rate >= kSlowestSimulation && rate <= kFastestSimulation && std::abs(rate - 1.0) > kClockTolerance;
  return is_scaled ? rate : 1.0;
}

CheckResults check_imu_stream(const VehicleRecording& recording) {
  CheckResults results = {check_received("imu", recording.imu, recording.duration_s())};
  const SampleTimes samples = times_of(recording.imu);
  if (samples.size() < kFewest) return results;
  const SequenceCounts counts = count_sequence(samples);
  const double clock = clock_rate(samples);
  const bool simulated = recording.description && recording.description->simulated;
  results.push_back(check_sequence("imu", counts));
  results.push_back(check_stamps("imu", counts));
  results.push_back(check_clock("imu", clock, simulated));
  const bool stamps_count =
      results.back().verdict == Verdict::kPass && counts.stamps_still + counts.stamps_back == 0;
  const bool keeps_clock = stamps_count && std::abs(clock - 1.0) <= kClockTolerance &&
                           (!simulated || clock_slip_s(samples) <= kSimulationSlip_s);
  results.push_back(
      check_imu_rate(recording, stamps_count ? rate_by_stamps(samples) : rate_by_arrivals(samples)));
  results.push_back(check_gap(
      "imu", stamps_count ? longest_interval_by_stamps_s(samples) : longest_interval_by_arrivals_s(samples),
      kImuGap_s));
  const double jitter_limit = closes_inner_loops(recording) ? kOuterStampJitter : kStampJitter;
  results.push_back(stamps_count ? check_stamp_jitter(stamp_jitter_p99(samples), jitter_limit)
                                 : skipped("imu.jitter", "the stamps do not follow the clock"));
  results.push_back(keeps_clock ? check_delivery(delivery_delay_p99_s(samples))
                                : skipped("imu.delivery", "the stamps do not follow the computer's clock"));
  results.push_back(check_imu_age(recording, samples, keeps_clock));
  return results;
}

CheckResults check_odometry_stream(const VehicleRecording& recording) {
  const std::string topic = "vehicle_odometry";
  CheckResults results = {check_received(topic, recording.odometry, recording.duration_s())};
  const SampleTimes samples = times_of(recording.odometry);
  if (samples.size() < kFewest) return results;
  const SequenceCounts counts = count_sequence(samples);
  const bool simulated = recording.description && recording.description->simulated;
  results.push_back(check_sequence(topic, counts));
  results.push_back(check_stamps(topic, counts));
  results.push_back(check_clock(topic, clock_rate(samples), simulated));
  const double rate_hz = rate_by_arrivals(samples);
  results.push_back(
      judged(check_name(topic, "rate"), figure(rate_hz, "Hz", 1),
             fmt::format("at least {:g} Hz", kLeastOdometryRate_hz),
             rate_hz >= kLeastOdometryRate_hz ? "" : fmt::format("too slow: {:.1f} Hz", rate_hz)));
  results.push_back(check_gap(topic, longest_interval_by_arrivals_s(samples), kImuGap_s));
  return results;
}

CheckResults check_battery_stream(const VehicleRecording& recording) {
  return check_stream(kBatteryLimits, recording.battery, recording);
}

CheckResults check_rotor_speed_stream(const VehicleRecording& recording) {
  if (!recording.rotor_speeds.published && recording.rotor_speeds.samples.empty())
    return {skipped("rotor_speeds.received", "optional, and nobody publishes it")};
  return check_stream(kRotorSpeedLimits, recording.rotor_speeds, recording);
}

CheckResults check_mocap_stream(const VehicleRecording& recording, bool required) {
  if (!required && !recording.mocap.published && recording.mocap.samples.empty())
    return {skipped("mocap_pose.received", "nobody publishes it; start motion capture to check it too")};
  return check_stream(kMocapLimits, recording.mocap, recording);
}

}  // namespace swiftlet::ground
