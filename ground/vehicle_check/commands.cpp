#include "swiftlet/ground/vehicle_check/commands.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/core.h>

#include "swiftlet/ground/vehicle_check/rotor_activity.hpp"
#include "swiftlet/ground/vehicle_check/stream_statistics.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kAnswer_s = 0.05;
constexpr double kLeastTimeout_s = 0.05;
constexpr double kLongestTimeout_s = 1.0;
constexpr std::int64_t kLastPart_ns = 200'000'000;
constexpr std::int64_t kOnItsWay_ns = 30'000'000;  // a sample may still report what was before

std::optional<bool> turn_at_end(const VehicleRecording& recording, const CommandPhase& phase) {
  return rotors_turn(recording, phase.end_ns - kLastPart_ns, phase.end_ns);
}

const char* turning_text(const std::optional<bool>& turning) {
  if (!turning) return "not reported";
  return *turning ? "rotors turn" : "rotors stand";
}

constexpr const char* kNotTold =
    "the vehicle publishes neither rotor_speeds nor rotors_running of vehicle_info: watch the rotors";

// Whether the rotors do at the end of a phase what they should.
CheckResult check_turning(const std::string& name, const VehicleRecording& recording,
                          const CommandPhase& phase, bool should_turn, const std::string& otherwise) {
  const std::optional<bool> turning = turn_at_end(recording, phase);
  if (!turning) return skipped(name, kNotTold);
  return judged(name, {*turning ? 1.0 : 0.0, "", turning_text(turning)},
                should_turn ? "rotors turn" : "rotors stand", *turning == should_turn ? "" : otherwise);
}

bool reports_obeyed(const VehicleRecording& recording) {
  const auto& samples = recording.imu.samples;
  return std::any_of(samples.begin(), samples.end(),
                     [](const auto& received) { return received.sample.obeyed.reported; });
}

// How far the obeyed command lies behind the sample that reports it.
CheckResult check_obeyed(const VehicleRecording& recording, const CommandPhase& idle) {
  constexpr const char* kName = "commands.obeyed";
  if (!reports_obeyed(recording))
    return skipped(kName,
                   "the vehicle does not report obeyed commands in imu; standbys then cannot monitor it");
  std::vector<double> delays;
  std::size_t other_term = 0;
  for (const auto& received : recording.imu.samples) {
    if (received.received_ns < idle.begin_ns + kOnItsWay_ns || received.received_ns > idle.end_ns) continue;
    const plant::ObeyedCommand& obeyed = received.sample.obeyed;
    if (!obeyed.any) continue;
    other_term += obeyed.term != idle.term ? 1 : 0;
    delays.push_back(1e-9 * static_cast<double>(received.sample.imu.stamp_ns - obeyed.stamp_ns));
  }
  if (delays.empty())
    return missing(
        kName,
        "commands do not reach the vehicle, or it obeys none: its reader must be best effort and volatile, "
        "with shared ownership and no deadline");
  const double delay_s = quantile(std::move(delays), 0.95);
  std::string finding;
  if (other_term > 0) {
    finding = fmt::format("{} samples report the term of another command", other_term);
  } else if (!(delay_s >= 0.0 && delay_s <= kAnswer_s)) {
    finding = fmt::format(
        "the command that is reported answers a sample {:.0f} ms before: commands arrive late, or "
        "command_stamp_ns is not the stamp of the command",
        1e3 * delay_s);
  }
  return judged(kName, figure(1e3 * delay_s, "ms", 1, " from sample to obeyed command, p95"),
                fmt::format("at most {:.0f} ms", 1e3 * kAnswer_s), finding);
}

std::optional<plant::PerRotor> speeds_before(const VehicleRecording& recording, const CommandPhase& phase) {
  return mean_rotor_speeds(recording, phase.begin_ns - kLastPart_ns, phase.begin_ns);
}

CheckResult check_lower_term(const VehicleRecording& recording, const CommandPhase& phase) {
  constexpr const char* kName = "commands.lower_term";
  constexpr const char* kFinding =
      "the vehicle obeys commands of a lower term: a controller that was overtaken could fly it";
  if (!reports_obeyed(recording))
    return skipped(kName, "the vehicle does not report obeyed commands; it must obey the highest term");
  std::size_t samples = 0;
  std::size_t lower = 0;
  for (const auto& received : recording.imu.samples) {
    if (received.received_ns < phase.begin_ns + kOnItsWay_ns || received.received_ns > phase.end_ns) continue;
    ++samples;
    lower += received.sample.obeyed.any && received.sample.obeyed.term == phase.term ? 1 : 0;
  }
  if (samples == 0) return missing(kName, "missing: no imu message arrived in this step");
  const auto before = speeds_before(recording, phase);
  const bool slowed = before && rotors_slow_at(recording, phase.begin_ns, phase.end_ns, before).has_value();
  return judged(
      kName,
      {static_cast<double>(lower), "", fmt::format("{} of {} samples report it as obeyed", lower, samples)},
      "none", lower > 0 || slowed ? kFinding : "");
}

CheckResult check_timeout(const VehicleRecording& recording, const CommandPhase& silence) {
  constexpr const char* kName = "commands.timeout";
  if (!turn_at_end(recording, silence)) return skipped(kName, kNotTold);
  const auto slow_ns =
      rotors_slow_at(recording, silence.begin_ns, silence.end_ns, speeds_before(recording, silence));
  const std::string limit = fmt::format("{:g} to {:g} s", kLeastTimeout_s, kLongestTimeout_s);
  const double waited_s = 1e-9 * static_cast<double>(silence.end_ns - silence.begin_ns);
  if (!slow_ns)
    return judged(kName, figure(waited_s, "s", 2, " without a command, rotors still turn"), limit,
                  "ignored time-out: the rotors do not stop when commands cease");
  const double timeout_s = 1e-9 * static_cast<double>(*slow_ns - silence.begin_ns);
  std::string finding;
  if (timeout_s > kLongestTimeout_s) finding = "the rotors stop too late when commands cease";
  if (timeout_s < kLeastTimeout_s)
    finding = "the rotors stop at once when a command is missing: a lost datagram ends a flight";
  return judged(kName, figure(timeout_s, "s", 2, " until the rotors slow down"), limit, finding);
}

std::optional<bool> last_report(const VehicleRecording& recording, const CommandPhase& phase) {
  std::optional<bool> running;
  for (const Received<bool>& report : recording.rotors_running) {
    if (report.received_ns <= phase.end_ns) running = report.sample;
  }
  return running;
}

// Above level actuators the take-off waits for this report.
CheckResult check_running_report(const VehicleRecording& recording, const CommandPhase& idle,
                                 const CommandPhase& stopped) {
  constexpr const char* kName = "commands.rotors_running";
  const bool started = last_report(recording, idle).value_or(false);
  const bool stands = !last_report(recording, stopped).value_or(false);
  std::string finding;
  if (!stands) finding = "rotors_running of vehicle_info stays true after ROTORS_OFF";
  if (!started)
    finding = "rotors_running of vehicle_info does not become true: control waits for it with each take-off";
  return judged(kName,
                {started ? 1.0 : 0.0, "", fmt::format("{} after start, {} after stop", started, !stands)},
                "true, then false", finding);
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
  CheckResults results = {
      check_turning("commands.off", recording, *off, false,
                    "rotors turn while off: ROTORS_OFF is a state of its own, not throttle 0"),
      check_obeyed(recording, *idle),
      check_turning("commands.idle", recording, *idle, true,
                    "the rotors do not start: ROTORS_RUNNING at throttle 0 turns them slowly"),
      check_lower_term(recording, *lower),
      check_timeout(recording, *silence),
      check_turning("commands.stop", recording, *stopped, false,
                    "rotors turn while off: they do not stop on ROTORS_OFF")};
  if (recording.description && closes_inner_loops(recording.description->levels))
    results.push_back(check_running_report(recording, *idle, *stopped));
  return results;
}

}  // namespace swiftlet::ground
