// What the thread of the link measures. No heap.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "swiftlet/services/microcontroller/protocol/messages.hpp"
#include "swiftlet/services/runtime/latency_histogram.hpp"
#include "swiftlet/services/vehicle_template/microcontroller_link.hpp"

namespace swiftlet::services {

// Latencies and numbers of answers are those since the rotors started last.
struct LinkMeasurements {
  LinkStatus link;
  protocol::State state;
  // From the stamp of a sample to its arrival at the host, by the microcontroller's clock as the host knows it.
  runtime::LatencyHistogram sample_to_host;
  // From the stamp of a sample until the microcontroller obeyed its answer, by the microcontroller's clock alone.
  runtime::LatencyHistogram sample_to_motor;
  std::uint64_t samples = 0;
  std::uint64_t answered = 0;
  std::uint64_t late = 0;  // answers obeyed later than one IMU period

  // microcontroller_ns: its clock at the arrival of the sample, if it is known.
  void note(const protocol::Imu& sample, std::optional<std::int64_t> microcontroller_ns) {
    ++samples;
    if (microcontroller_ns) sample_to_host.record(*microcontroller_ns - protocol::ns_of_us(sample.stamp_us));
    if (sample.has_command == 0 || sample.command_stamp_us == command_stamp_us_) return;
    command_stamp_us_ = sample.command_stamp_us;
    sample_to_motor.record(std::int64_t{sample.command_age_us} * 1000);
    const int rate_hz = link.microcontroller ? link.microcontroller->imu_rate_hz : 0;
    if (std::int64_t{sample.command_age_us} * rate_hz > 1'000'000) ++late;
  }

  void note(const protocol::State& report) {
    if (report.rotors_running != 0 && state.rotors_running == 0) {
      sample_to_host.reset();
      sample_to_motor.reset();
      samples = late = 0;
      obeyed_before_ = report.commands_obeyed;
    }
    if (report.commands_obeyed < obeyed_before_) obeyed_before_ = 0;  // it has restarted
    state = report;
    answered = std::min<std::uint64_t>(state.commands_obeyed - obeyed_before_, samples);
  }

 private:
  std::int64_t command_stamp_us_ = -1;
  std::uint32_t obeyed_before_ = 0;
};

}  // namespace swiftlet::services
