#include "swiftlet/ground/vehicle_check/commands.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/ground/vehicle_check/checks.hpp"
#include "swiftlet/ground/vehicle_check/stream_statistics.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::int64_t kLastPart_ns = 200'000'000;
constexpr std::int64_t kOnItsWay_ns = 30'000'000;  // a sample may still report what was before

constexpr double kTurning_rad_s = 30.0;  // five turns a second
constexpr double kSlowed = 0.8;          // of the speed before

bool is_slowed(const plant::RotorSpeedSample& sample, const plant::PerRotor& before) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(sample.rotor_count); ++i) {
    if (sample.speeds[i] > kSlowed * before[i]) return false;
  }
  return true;
}

// The last report of vehicle_info up to this time.
std::optional<bool> running_report(const VehicleRecording& recording, std::int64_t end_ns) {
  std::optional<bool> running;
  for (const Received<bool>& report : recording.rotors_running) {
    if (report.received_ns <= end_ns) running = report.sample;
  }
  return running;
}

// At the end of this time: by rotor_speeds, else by vehicle_info; nullopt if the vehicle publishes neither.
std::optional<bool> rotors_turn(const VehicleRecording& recording, std::int64_t begin_ns,
                                std::int64_t end_ns) {
  if (const auto speeds = mean_rotor_speeds(recording, begin_ns, end_ns))
    return *std::max_element(speeds->begin(), speeds->end()) > kTurning_rad_s;
  return running_report(recording, end_ns);
}

// The first time in begin_ns .. end_ns at which the rotors were seen to slow down or to be off. speeds_before: while they
// ran, empty if not measured.
std::optional<std::int64_t> rotors_slow_at(const VehicleRecording& recording, std::int64_t begin_ns,
                                           std::int64_t end_ns,
                                           const std::optional<plant::PerRotor>& speeds_before) {
  if (speeds_before) {
    for (const auto& received : recording.rotor_speeds.samples) {
      if (received.received_ns >= begin_ns && received.received_ns <= end_ns &&
          is_slowed(received.sample, *speeds_before))
        return received.received_ns;
    }
    return std::nullopt;
  }
  for (const Received<bool>& report : recording.rotors_running) {
    if (report.received_ns >= begin_ns && report.received_ns <= end_ns && !report.sample)
      return report.received_ns;
  }
  return std::nullopt;
}

std::optional<bool> turn_at_end(const VehicleRecording& recording, const CommandPhase& phase) {
  return rotors_turn(recording, phase.end_ns - kLastPart_ns, phase.end_ns);
}

constexpr const char* kNotTold =
    "the vehicle publishes neither rotor_speeds nor rotors_running of vehicle_info: watch the rotors";

// Whether the rotors do at the end of a phase what they should.
CheckResult check_turning(const Check& check, const VehicleRecording& recording, const CommandPhase& phase) {
  const std::optional<bool> turning = turn_at_end(recording, phase);
  if (!turning) return skipped(check.name, kNotTold);
  return judge(check, *turning ? 1.0 : 0.0, {{"turning", *turning ? "rotors turn" : "rotors stand"}});
}

// The samples of a phase that may report what was commanded in it.
std::vector<ImuReport> reports_of(const VehicleRecording& recording, const CommandPhase& phase) {
  std::vector<ImuReport> reports;
  for (const auto& received : recording.imu.samples) {
    if (received.received_ns >= phase.begin_ns + kOnItsWay_ns && received.received_ns <= phase.end_ns)
      reports.push_back(received.sample);
  }
  return reports;
}

bool reports_obeyed(const VehicleRecording& recording) {
  const auto& samples = recording.imu.samples;
  return std::any_of(samples.begin(), samples.end(),
                     [](const auto& received) { return received.sample.obeyed.reported; });
}

// How far the obeyed command lies behind the sample that reports it.
CheckResult check_obeyed(const VehicleRecording& recording, const CommandPhase& idle) {
  if (!reports_obeyed(recording))
    return skipped(kCommandObeyed.name,
                   "the vehicle does not report obeyed commands in imu; standbys then cannot monitor it");
  std::vector<double> delays;
  std::size_t others = 0;
  for (const ImuReport& report : reports_of(recording, idle)) {
    if (!report.obeyed.any) continue;
    others += report.obeyed.term != idle.term ? 1 : 0;
    delays.push_back(math::seconds(report.imu.stamp_ns - report.obeyed.stamp_ns));
  }
  if (delays.empty())
    return missing(
        kCommandObeyed.name,
        "commands do not reach the vehicle, or it obeys none: its reader must be best effort and volatile, "
        "with shared ownership and no deadline");
  const double delay_ms = 1e3 * quantile(std::move(delays), 0.95);
  if (others == 0) return judge(kCommandObeyed, delay_ms);
  return judge_by(kCommandObeyed, delay_ms, "{others:.0f} samples report the term of another command",
                  {{"others", others}});
}

std::optional<plant::PerRotor> speeds_before(const VehicleRecording& recording, const CommandPhase& phase) {
  return mean_rotor_speeds(recording, phase.begin_ns - kLastPart_ns, phase.begin_ns);
}

CheckResult check_lower_term(const VehicleRecording& recording, const CommandPhase& phase) {
  if (!reports_obeyed(recording))
    return skipped(kCommandLowerTerm.name,
                   "the vehicle does not report obeyed commands; it must obey the highest term");
  const std::vector<ImuReport> reports = reports_of(recording, phase);
  if (reports.empty()) return missing(kCommandLowerTerm.name, "missing: no imu message arrived in this step");
  const auto lower = std::count_if(reports.begin(), reports.end(), [&](const ImuReport& report) {
    return report.obeyed.any && report.obeyed.term == phase.term;
  });
  const auto before = speeds_before(recording, phase);
  const bool slowed = before && rotors_slow_at(recording, phase.begin_ns, phase.end_ns, before).has_value();
  return judge_by(
      kCommandLowerTerm, static_cast<double>(lower),
      lower > 0 || slowed
          ? "the vehicle obeys commands of a lower term: a controller that was overtaken could fly it"
          : "",
      {{"samples", reports.size()}});
}

CheckResult check_timeout(const VehicleRecording& recording, const CommandPhase& silence) {
  if (!turn_at_end(recording, silence)) return skipped(kCommandTimeout.name, kNotTold);
  const auto slow_ns =
      rotors_slow_at(recording, silence.begin_ns, silence.end_ns, speeds_before(recording, silence));
  if (!slow_ns)
    return judge_by(kCommandIgnoredTimeout, math::seconds(silence.end_ns - silence.begin_ns),
                    "ignored time-out: the rotors do not stop when commands cease");
  return judge(kCommandTimeout, math::seconds(*slow_ns - silence.begin_ns));
}

// Above level actuators the take-off waits for this report.
CheckResult check_running_report(const VehicleRecording& recording, const CommandPhase& idle,
                                 const CommandPhase& stopped) {
  const bool started = running_report(recording, idle.end_ns).value_or(false);
  const bool stands = !running_report(recording, stopped.end_ns).value_or(false);
  std::string finding;
  if (!stands) finding = "rotors_running of vehicle_info stays true after ROTORS_OFF";
  if (!started)
    finding = "rotors_running of vehicle_info does not become true: control waits for it with each take-off";
  return judge_by(kCommandRunningReport, started ? 1.0 : 0.0, finding,
                  {{"started", started ? "true" : "false"}, {"stopped", stands ? "false" : "true"}});
}

}  // namespace

const CommandPhase* phase_of(const CommandPhases& phases, CommandStage stage) {
  const auto found =
      std::find_if(phases.begin(), phases.end(), [&](const auto& phase) { return phase.stage == stage; });
  return found == phases.end() ? nullptr : &*found;
}

CheckResults check_commands(const VehicleRecording& recording, const CommandPhases& phases) {
  const CommandPhase* const off = phase_of(phases, CommandStage::kOff);
  const CommandPhase* const idle = phase_of(phases, CommandStage::kIdle);
  const CommandPhase* const lower = phase_of(phases, CommandStage::kLowerTerm);
  const CommandPhase* const silence = phase_of(phases, CommandStage::kSilence);
  const CommandPhase* const stopped = phase_of(phases, CommandStage::kStopped);
  if (off == nullptr || idle == nullptr || lower == nullptr || silence == nullptr || stopped == nullptr)
    return {missing("commands.steps", "missing: the steps with commands were not completed")};
  CheckResults results = {check_turning(kCommandOff, recording, *off),
                          check_obeyed(recording, *idle),
                          check_turning(kCommandIdle, recording, *idle),
                          check_lower_term(recording, *lower),
                          check_timeout(recording, *silence),
                          check_turning(kCommandStop, recording, *stopped)};
  if (recording.description && closes_inner_loops(recording.description->levels))
    results.push_back(check_running_report(recording, *idle, *stopped));
  return results;
}

}  // namespace swiftlet::ground
