#include "swiftlet/ground/flight/network_transport.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/client/action.hpp"
#include "swiftlet/ground/flight/missing.hpp"
#include "swiftlet/ground/flight/vehicle_motion.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;
using simulation::FlightSchedule;
using ControlMode = control::Mode;

constexpr auto kReadyTimeout = 20s;
constexpr auto kTransferTimeout = 10s;
constexpr auto kRetryPeriod = 200ms;
constexpr auto kStep = 50ms;
constexpr auto kClockTime = 500ms;  // in which a fleet asks for the clock of a vehicle
constexpr auto kClockTimeout = 5s;
constexpr auto kClockStep = 5ms;
constexpr std::int64_t kStartAheadNs =
    200'000'000;  // in lockstep: the start, after the last vehicle is ready
constexpr std::int64_t kRealtimeStartAheadNs = 1'000'000'000;
constexpr auto kLastFiguresTimeout = 1500ms;
constexpr auto kEndTimeout = 2s;
constexpr auto kResultTimeout = 1s;    // of control_status after mission_status
constexpr double kLongestStepS = 0.2;  // of this process, between two polls
constexpr auto kControlSilence = 1s;
constexpr double kSilenceAfterExitS = 1.0;  // of a vehicle that is to land after a process has ended
constexpr int kBeforeFlight = -1;           // progress stage; the later stages are the mission's items

ControlMode mode_of(const View& view) { return static_cast<ControlMode>(view.control.message.mode()); }

// By what control says, or while control is silent, by what the vehicle says.
bool is_down(const View& view) {
  const bool is_silent = Clock::now() - view.control.received > kControlSilence;
  const bool has_stopped =
      view.vehicle.received > view.control.received && !view.vehicle.message.rotors_running();
  return rotors_off(mode_of(view)) || (is_silent && has_stopped);
}

// Simulated time since `since_ns`. The time limits of a flight are in the vehicle's time.
double simulated_s(const View& view, std::int64_t since_ns) {
  return static_cast<double>(motion_of(view).stamp_ns - since_ns) * 1e-9;
}

}  // namespace

NetworkTransport::NetworkTransport(const std::shared_ptr<Client>& client, const io::MissionFile& mission,
                                   runtime::Clock clock, Watch watch, io::Progress& progress)
    : client_(*client),
      vehicle_(client),
      mission_(mission),
      lockstep_(clock == runtime::Clock::kLockstep),
      watch_(std::move(watch)),
      progress_(progress) {
  vehicle_.cancel_when([this] { return watch_.exited_process() || watch_.interrupts() > 0; });
}

NetworkTransport::~NetworkTransport() { vehicle_.disable_link_loss_failsafe(); }

// Only time in which this process was running counts: a stalled computer is not the peer's fault.
bool NetworkTransport::Silence::lasts(std::uint64_t sample_count, double limit_s) {
  const auto now = Clock::now();
  const double step_s = std::min(std::chrono::duration<double>(now - polled_).count(), kLongestStepS);
  polled_ = now;
  lasted_s_ = sample_count == count_ ? lasted_s_ + step_s : 0.0;
  count_ = sample_count;
  return lasted_s_ > limit_s;
}

void NetworkTransport::require_alive() const {
  if (const auto exited_process = watch_.exited_process()) throw simulation::FlightFailure(*exited_process);
}

// What has ended, and what the others do then: in real time the vehicle lands first, by control or by its own failsafe.
void NetworkTransport::require_alive_in_flight() {
  if (lockstep_) return require_alive();
  if (const auto exited_process = watch_.exited_process()) abandon(*exited_process);
}

void NetworkTransport::require_no_interrupt() const {
  if (watch_.interrupts() > 0) throw simulation::FlightFailure("interrupted before take-off");
}

double NetworkTransport::vehicle_s() const {
  return ready_ns_ ? simulated_s(client_.view(), *ready_ns_) : 0.0;
}

bool NetworkTransport::publishes_truth() const {
  const std::vector<std::string> topics = client_.node().topics_seen();
  return std::count(topics.begin(), topics.end(),
                    "rt/" + client_.vehicle() + "/" + messages::topics::kGroundTruth.name) > 0;
}

void NetworkTransport::wait_until_ready() {
  const auto start = Clock::now();
  while (true) {
    std::string absent;
    const bool has_truth = !watch_.attached || publishes_truth();
    const bool ready = client_.wait(kStep, [&](const View& view) {
      absent = lockstep_ ? missing_peer(view) : missing(view, has_truth);
      return absent.empty();
    });
    if (ready) break;
    require_alive();
    require_no_interrupt();
    const auto waited = Clock::now() - start;
    if (waited > kReadyTimeout) {
      throw simulation::FlightFailure("not ready after 20 s: missing " + absent + "; looked for " +
                                      client_.where());
    }
    progress_.update(kBeforeFlight, "waiting for " + absent);
  }
  if (lockstep_) client_.simulation_clock().up_to(0);
  ready_ns_ = lockstep_ ? 0 : motion_of(client_.view()).stamp_ns;
  wait_until_recorded();
  if (!lockstep_) {
    // In lockstep time stands still without this process, and the plant ends the run.
    vehicle_.enable_link_loss_failsafe();
    return;
  }
  wait_until_paused_at(simulation::FlightSchedule::kFirstRequestNs);
}

void NetworkTransport::wait_until(const std::function<bool(const View&)>& holds,
                                  const std::string& what_not) {
  const auto start = Clock::now();
  while (!client_.wait(kStep, holds)) {
    require_alive();
    require_no_interrupt();
    if (Clock::now() - start > kReadyTimeout)
      throw simulation::FlightFailure("not ready after 20 s: " + what_not);
  }
}

// In lockstep before time advances: a discovered peer may not have discovered the recorder yet, and it sends each sample once. Only
// the first samples are repeated while time is paused.
void NetworkTransport::wait_until_recorded() {
  wait_until([this](const View&) { return watch_.is_recorded(); },
             "the record has no first samples from plant, mocap and control");
}

// Lets time advance up to stamp_ns and waits until the plant has reached it and all samples are answered.
void NetworkTransport::wait_until_paused_at(std::int64_t stamp_ns) {
  client_.simulation_clock().up_to(stamp_ns);
  paused_at_ns_ = stamp_ns;
  const auto paused = [stamp_ns](const View& view) {
    return view.vehicle.message.paused() && view.vehicle.message.stamp_ns() >= stamp_ns;
  };
  wait_until(paused, "simulated time has not reached " + std::to_string(stamp_ns) + " ns");
}

simulation::MissionTransport::Reply NetworkTransport::arm() {
  const Result answer = vehicle_.arm(kTransferTimeout).answer();
  require_alive();
  armed_ = answer;
  if (answer.kind == Result::Kind::kSilence || answer.kind == Result::Kind::kCancelled) {
    vehicle_.cancel_when({});
    armed_ = vehicle_.disarm(kResultTimeout).answer();  // the request may have armed it all the same
  }
  if (answer.accepted() && watch_.interrupts() > 0) abandon("interrupted before take-off");
  require_no_interrupt();
  return {answer.accepted(), answer.kind == Result::Kind::kRefused, answer.reason};
}

void NetworkTransport::wait(std::int64_t duration_ns, const std::string& reason) {
  progress_.update(kBeforeFlight, reason);
  if (lockstep_) return wait_until_paused_at(paused_at_ns_ + duration_ns);
  client_.wait(std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::nanoseconds(duration_ns)),
               [this](const View&) { return watch_.interrupts() > 0; });
}

std::int64_t NetworkTransport::at_vehicle_rate(std::int64_t host_ns) const {
  return watch_.speed == 1.0 ? host_ns : std::llround(static_cast<double>(host_ns) * watch_.speed);
}

void NetworkTransport::update_clock_offset(clocks::ClockClient& vehicle_clock) {
  vehicle_clock.ask_if_due();
  const std::int64_t now_ns = at_vehicle_rate(runtime::monotonic_ns());
  if (const auto stamp_ns = vehicle_clock.to_vehicle(now_ns)) clock_offset_ns_ = *stamp_ns - now_ns;
}

void NetworkTransport::learn_clock_offset(clocks::ClockClient& vehicle_clock) {
  const auto start = Clock::now();
  for (Clock::duration asked{}; asked < kClockTime || !clock_offset_ns_; asked = Clock::now() - start) {
    require_alive();
    if (watch_.interrupts() > 0) abandon("interrupted before take-off");
    if (asked > kClockTimeout)
      abandon("the vehicle does not answer clock_request: vehicles that start together need a common clock");
    update_clock_offset(vehicle_clock);
    client_.wait(kClockStep, [](const View&) { return false; });
  }
}

void NetworkTransport::wait_for_other_vehicles() {
  if (watch_.barrier == nullptr) return;
  std::optional<clocks::ClockClient> vehicle_clock;
  if (!lockstep_) {
    vehicle_clock.emplace(
        client_.node(), [this] { return at_vehicle_rate(runtime::monotonic_ns()); },
        clocks::ClockClient::Reporting::kNone);
    learn_clock_offset(*vehicle_clock);
  }
  if (const Result answer = vehicle_.upload(mission_.mission, kTransferTimeout).answer();
      !answer.accepted()) {
    require_alive_in_flight();
    abandon(watch_.interrupts() > 0 ? "interrupted" : "mission refused: " + answer.reason);
  }
  watch_.barrier->ready(lockstep_ ? paused_at_ns_ : runtime::monotonic_ns());
  while (!watch_.barrier->wait_for_all(kStep)) {
    require_alive_in_flight();
    const auto failure = watch_.barrier->failure();
    if (failure || watch_.interrupts() > 0) abandon(failure.value_or("interrupted"));
    progress_.update(kBeforeFlight, "armed, waiting for the other vehicles");
    if (vehicle_clock) update_clock_offset(*vehicle_clock);
  }
  const std::int64_t all_ready_ns = watch_.barrier->ready_ns();
  start_ns_ = lockstep_ ? all_ready_ns + kStartAheadNs
                        : at_vehicle_rate(all_ready_ns + kRealtimeStartAheadNs) + *clock_offset_ns_;
}

simulation::MissionTransport::Reply NetworkTransport::start_mission() {
  Result answer{Result::Kind::kAccepted, ""};
  if (watch_.barrier == nullptr) answer = vehicle_.upload(mission_.mission, kTransferTimeout).answer();
  if (answer.accepted()) {
    control::Request start;
    start.kind = control::RequestKind::kMissionStart;
    start.mission_id = vehicle_.uploaded_id();
    start.start_ns = start_ns_;
    answer = vehicle_.request(start, kTransferTimeout).answer();
  }
  require_alive_in_flight();
  start_ = answer;
  if (watch_.interrupts() > 0) abandon("interrupted");
  if (answer.accepted() && lockstep_) time_.emplace(client_, paused_at_ns_);
  return {answer.accepted(), false, answer.reason};
}

void NetworkTransport::advance() {
  const std::uint64_t id = client_.mission_id();
  const std::uint64_t statuses = client_.view().control.count;
  // Returns early when the mission is completed, in lockstep with each status, else after kStep.
  client_.wait(kStep, [&](const View& view) {
    return (lockstep_ && view.control.count != statuses) ||
           (view.mission.message.mission_id() == id &&
            view.mission.message.state() == msg::MissionStatus_Constants::COMPLETED);
  });
  require_alive_in_flight();
  const View view = client_.view();
  if (time_) time_->follow(view);
  update_progress(view);
  yield_to_other_tool(view);
  if (watch_.interrupts() > 0) abandon("interrupted");
  if (watch_.barrier != nullptr) {
    if (const auto failure = watch_.barrier->failure()) abandon(*failure);
  }
  if (control_silence_.lasts(view.control.count)) fail_silent("control");
  if (vehicle_silence_.lasts(motion_of(view).count)) fail_silent("the vehicle");
  // Another process may publish the truth (swiftlet-plant --truth-only): control repeats its status with the stamp of
  // the last sample.
  const auto answered_ns = static_cast<std::uint64_t>(view.control.message.stamp_ns());
  if (!lockstep_ && sample_silence_.lasts(answered_ns)) fail_silent("the vehicle");
}

// Ends the flight if another tool's request or setpoints have ended the mission. The processes of an attached
// vehicle outlive this one: the other tool goes on flying it.
void NetworkTransport::yield_to_other_tool(const View& view) {
  const auto& mission = view.mission.message;
  if (mission.mission_id() != client_.mission_id() ||
      mission.state() != msg::MissionStatus_Constants::ABORTED)
    return;
  std::optional<ActionResult> result;
  client_.wait(kResultTimeout, [&](const View& news) {
    result = action_result_by(news.control.message, start_);
    return result.has_value();
  });
  if (!result || result->kind != ActionResult::Kind::kCanceled) return;
  if (!watch_.attached) abandon(interruption_by(*result));
  throw simulation::FlightFailure(interruption_by(*result) + "; the vehicle is left to it");
}

simulation::MissionTransport::Status NetworkTransport::status() const {
  const View view = client_.view();
  const auto& mission = view.mission.message;
  const bool flown = mission.mission_id() == client_.mission_id();
  return {motion_of(view).stamp_ns,
          flown ? static_cast<control::MissionState>(mission.state()) : control::MissionState::kNone,
          control::rotors_off(mode_of(view))};
}

std::string NetworkTransport::abort_reason() const { return client_.view().mission.message.reason().c_str(); }

// A killed process may be silent for seconds before its exit is seen: reports the exit if there is one.
void NetworkTransport::fail_silent(const std::string& who) {
  const auto deadline = Clock::now() + kEndTimeout;
  while (Clock::now() < deadline) {
    require_alive();
    client_.wait(kStep, [](const View&) { return false; });
  }
  throw simulation::FlightFailure(who + " has sent nothing for 3 s");
}

// Waits for vehicle_info and control_status after the landing: they carry the figures of the flight.
void NetworkTransport::wait_for_last_figures() {
  const auto landed = Clock::now();
  client_.wait(kLastFiguresTimeout, [landed](const View& view) {
    return !view.vehicle.message.rotors_running() && view.vehicle.received > landed &&
           view.control.received > landed;
  });
}

// Whether the vehicle does what the answered request asked. A request that was under way may have ended the landing.
bool NetworkTransport::lands(const Result& landing) const {
  return landing.accepted() && simulation::comes_down(mode_of(client_.view()));
}

// Whether another tool ended the landing of a vehicle that outlives this process.
bool NetworkTransport::is_taken_over(const Result& landing) const {
  if (!watch_.attached || !landing.accepted()) return false;
  const View view = client_.view();
  const msg::ControlStatus& status = view.control.message;
  const auto result = action_result_by(status, landing);
  if (!result || result->kind != ActionResult::Kind::kCanceled) return false;
  return mode_of(view) == ControlMode::kSetpoint || status.request().client() != landing.key.client;
}

// In lockstep. Returns when the rotors are off, or with the answer to the request to land.
Result NetworkTransport::land_after_abort() {
  const int interrupts_before = watch_.interrupts();
  client_.wait(kResultTimeout, [this](const View& view) { return time_->has_left_mission(view); });
  time_->follow(client_.view());
  const auto is_decided = [this](const View& view) {
    return rotors_off(mode_of(view)) || time_->stands(view);
  };
  Result landing;
  Silence silence;
  while (!watch_.exited_process() && watch_.interrupts() == interrupts_before &&
         !silence.lasts(motion_of(client_.view()).count)) {
    update_progress(client_.view());
    if (!client_.wait(kStep, is_decided)) continue;
    const ControlMode mode = mode_of(client_.view());
    if (rotors_off(mode)) break;
    if (!simulation::comes_down(mode)) {
      landing = vehicle_.land(FlightSchedule::kLandingSpeed, kResultTimeout).answer();
      break;
    }
    time_->go_on();
  }
  client_.simulation_clock().without_end();
  client_.wait(kResultTimeout, [](const View& view) {
    return rotors_off(mode_of(view)) || simulation::comes_down(mode_of(view));
  });
  return landing;
}

void NetworkTransport::abandon(const std::string& reason) {
  vehicle_.cancel_when({});
  const int interrupts_before = watch_.interrupts();
  const bool waits = time_ && status().mission == control::MissionState::kAborted;
  if (lockstep_ && !waits) client_.simulation_clock().without_end();  // disarming needs time to advance
  // A status from before the arming still says disarmed.
  client_.wait(kResultTimeout, [&](const View& view) {
    return view.control.message.stamp_ns() > armed_.stamp_ns || !rotors_off(mode_of(view));
  });
  const ControlMode mode = mode_of(client_.view());
  bool in_flight = start_.accepted() || (!rotors_off(mode) && mode != ControlMode::kArmed);
  progress_.say(reason + (in_flight ? "; landing" : "; disarming") +
                (interrupts_before > 0 ? " (interrupt again to quit at once)" : ""));
  const std::int64_t start_ns = motion_of(client_.view()).stamp_ns;
  const Clock::time_point began = Clock::now();
  Silence silence;
  Result landing;
  if (waits) landing = land_after_abort();
  while (!is_down(client_.view())) {
    const auto exited_process = watch_.exited_process();
    if (exited_process && lockstep_)
      throw simulation::FlightFailure(reason + "; while landing, " + *exited_process);
    if (watch_.interrupts() > std::max(1, interrupts_before))
      throw simulation::FlightFailure(reason + "; quit in flight");
    const double silence_s = exited_process ? kSilenceAfterExitS : kSilenceS;
    if (silence.lasts(client_.view().vehicle.count + motion_of(client_.view()).count, silence_s))
      throw simulation::FlightFailure(
          fmt::format("{}; while landing, the vehicle has sent nothing for {:g} s", reason, silence_s));
    // The stamps of a vehicle without ground truth are those of control.
    const double lasted_s = exited_process ? std::chrono::duration<double>(Clock::now() - began).count()
                                           : simulated_s(client_.view(), start_ns);
    if (lasted_s > FlightSchedule::kLandingTimeoutS)
      throw simulation::FlightFailure(reason + "; the vehicle did not land within 30 s");
    if (mode_of(client_.view()) == ControlMode::kArmed) {
      vehicle_.disarm(kRetryPeriod);
    } else if (is_taken_over(landing)) {
      throw simulation::FlightFailure(
          reason + "; while landing, another ground tool took over; the vehicle is left to it");
    } else if (!lands(landing)) {
      in_flight = true;
      landing = vehicle_.land(FlightSchedule::kLandingSpeed, kRetryPeriod).answer();
    }
    update_progress(client_.view());
    client_.wait(kRetryPeriod, is_down);
  }
  wait_for_last_figures();
  const ControlMode last = mode_of(client_.view());
  throw simulation::FlightFailure(
      reason + "; " +
      (rotors_off(last) ? simulation::end_of(last, in_flight) : "the vehicle has stopped its rotors"));
}

void NetworkTransport::update_progress(const View& view) {
  const auto& mission = view.mission.message;
  const std::array<double, 3> position = motion_of(view).position_ned;
  const bool is_own = mission.mission_id() == client_.mission_id();
  if (is_own && !mission_began_ns_ && mode_of(view) == ControlMode::kMission)
    mission_began_ns_ = motion_of(view).stamp_ns;
  const double time_s = mission_began_ns_ ? simulated_s(view, *mission_began_ns_) : 0.0;
  const std::size_t item = std::min<std::size_t>(mission.item_index(), mission_.mission.items.size() - 1);
  const std::string text = fmt::format(
      "{:5.1f} s  {}/{} {:<10}  ({:5.2f}, {:5.2f}, {:5.2f}) m, {:5.1f} mm off, {:.2f} V", time_s, item + 1,
      mission_.mission.items.size(), control::to_string(mission_.mission.items[item].kind), position[0],
      position[1], position[2], newest_error_m(view) * 1e3, view.battery.message.voltage_v());
  std::string line = text;
  if (mode_of(view) != ControlMode::kMission)
    line += std::string(", ") + mode_name(view.control.message.mode());
  progress_.update(static_cast<int>(item), line);
}

}  // namespace swiftlet::ground
