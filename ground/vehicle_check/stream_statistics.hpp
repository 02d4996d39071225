// Figures of the timing of a stream: what its stamps and sequence numbers say against the times of reception.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

namespace swiftlet::ground {

struct SampleTime {
  std::int64_t stamp_ns = 0;
  std::uint64_t sequence = 0;
  std::int64_t received_ns = 0;
};
using SampleTimes = std::vector<SampleTime>;

inline const plant::ImuSample& stamped(const ImuReport& report) { return report.imu; }
inline const plant::OdometrySample& stamped(const OdometryReport& report) { return report.odometry; }
template <class Sample>
const Sample& stamped(const Sample& sample) {
  return sample;
}

template <class Sample>
SampleTimes times_of(const TopicRecord<Sample>& topic) {
  SampleTimes times;
  for (const Received<Sample>& received : topic.samples) {
    const auto& sample = stamped(received.sample);
    times.push_back({sample.stamp_ns, sample.sequence, received.received_ns});
  }
  return times;
}

// Counts over the pairs of neighbours in the order of reception.
struct SequenceCounts {
  std::size_t pairs = 0;
  std::size_t repeated = 0;      // the same sequence number again
  std::size_t backward = 0;      // a lower one
  std::uint64_t lost = 0;        // numbers left out
  std::size_t stamps_still = 0;  // pairs with a higher number, but the same stamp
  std::size_t stamps_back = 0;   // pairs with a higher number, but a lower stamp
  double lost_part() const;      // of all that were sent
  std::size_t stamps_faulty() const { return stamps_still + stamps_back; }
};
SequenceCounts count_sequence(const SampleTimes& samples);

// Stamp seconds per second of the computer: 1 for stamps in ns, 0 for frozen stamps. Samples that were delayed on
// their way do not change it: fits a line to the earliest arrival of each tenth of the time. NaN for fewer than
// three samples.
double clock_rate(const SampleTimes& samples);

// Samples per second by their stamps, of which each is counted once. NaN for fewer than three stamps or if they do not rise.
double rate_by_stamps(const SampleTimes& samples);
double rate_by_arrivals(const SampleTimes& samples);
double longest_interval_s(const SampleTimes& samples, std::int64_t SampleTime::*time);

// 99 % of the intervals between stamps of consecutive numbers differ from their median by less than this part of it.
double stamp_jitter_p99(const SampleTimes& samples);
// 99 % of the samples are delivered at most this much later than the fastest.
double delivery_delay_p99_s(const SampleTimes& samples);

// By how much the stamps fell behind the computer's clock in the recording, or ran ahead of it: what a simulation does that
// pauses while its computer is busy. Bursts of up to a tenth of the recording are no slip, since the last sample of each is fast.
double clock_slip_s(const SampleTimes& samples);

// The value that this part of the numbers, 0 .. 1, does not exceed; NaN for none.
double quantile(std::vector<double> numbers, double part);

}  // namespace swiftlet::ground
