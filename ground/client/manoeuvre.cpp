#include "swiftlet/ground/client/manoeuvre.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "swiftlet/ground/client/manoeuvre_course.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::ground {
namespace {

using comms::wire::vector;
using control::Mode;

constexpr std::chrono::milliseconds kLookPeriod{100};
constexpr std::chrono::seconds kSilence{3};
// After the answer: what was on its way before it has come by then, at 10 Hz and at 100 Hz.
constexpr std::uint64_t kStaleStatuses = 2;
constexpr std::uint64_t kStaleReferences = 20;
constexpr double kAtPlace_m = 1e-3;      // the reference
constexpr double kThere_m = 0.05;        // the vehicle
constexpr double kStandstill_m_s = 0.1;  // likewise

const Ending kCompleted{Ending::Kind::kCompleted, ""};

Mode mode_of(const View& view) { return static_cast<Mode>(view.control.message.mode()); }

bool may_be_stale(const View& view, const Outset& outset) {
  return mode_of(view) == outset.mode && view.control.count <= outset.statuses + kStaleStatuses;
}

Ending interrupted(const View& view) {
  return {Ending::Kind::kInterrupted, std::string("it is ") + mode_name(view.control.message.mode()) + ": " +
                                          view.control.message.reason().c_str()};
}

// Exactly so on no path that moves.
bool rests(const msg::Reference& reference) {
  return vector(reference.velocity_ned()).isZero(0.0) && vector(reference.acceleration_ned()).isZero(0.0);
}

bool is_there(const View& view) {
  const Eigen::Vector3d at = vector(view.reference.message.position_ned());
  return (vector(view.estimate.message.position_ned()) - at).norm() < kThere_m &&
         vector(view.estimate.message.velocity_ned()).norm() < kStandstill_m_s;
}

Ending rests_elsewhere(const Eigen::Vector3d& at) {
  char text[128];
  std::snprintf(text, sizeof text, "it came to rest at (%.3f, %.3f, %.3f) m: something else was asked of it",
                at.x(), at.y(), at.z());
  return {Ending::Kind::kInterrupted, text};
}

}  // namespace

Judge at_once() {
  return [](const View&, const Outset&) -> std::optional<Ending> { return kCompleted; };
}

Judge until_mode(Mode goal, Mode way) {
  return [goal, way](const View& view, const Outset& outset) -> std::optional<Ending> {
    const Mode mode = mode_of(view);
    if (mode == goal) return kCompleted;
    if (mode == way || may_be_stale(view, outset)) return std::nullopt;
    return interrupted(view);
  };
}

Judge until_stopped() {
  return [](const View& view, const Outset&) -> std::optional<Ending> {
    if (mode_of(view) == Mode::kStopped) return kCompleted;
    return std::nullopt;
  };
}

Judge until_landed() {
  return [](const View& view, const Outset& outset) -> std::optional<Ending> {
    const Mode mode = mode_of(view);
    if (mode == Mode::kDisarmed) return kCompleted;
    if (mode == Mode::kLanding || mode == Mode::kDescent || may_be_stale(view, outset)) return std::nullopt;
    return interrupted(view);
  };
}

Judge until_at_rest(const std::optional<Eigen::Vector3d>& place_ned) {
  return [place_ned](const View& view, const Outset& outset) -> std::optional<Ending> {
    if (mode_of(view) != Mode::kHolding) {
      if (may_be_stale(view, outset)) return std::nullopt;
      return interrupted(view);
    }
    if (view.reference.count <= outset.references + kStaleReferences || !rests(view.reference.message))
      return std::nullopt;
    const Eigen::Vector3d at = vector(view.reference.message.position_ned());
    if (place_ned && (at - *place_ned).norm() > kAtPlace_m) return rests_elsewhere(at);
    if (!is_there(view)) return std::nullopt;
    return kCompleted;
  };
}

Judge until_trajectory_flown() {
  return [](const View& view, const Outset& outset) -> std::optional<Ending> {
    if (mode_of(view) == Mode::kTrajectory || may_be_stale(view, outset)) return std::nullopt;
    const bool completed =
        view.control.message.reason() == control::to_string(control::Reason::kTrajectoryCompleted);
    return completed ? kCompleted : interrupted(view);
  };
}

Judge until_mission_flown(std::uint64_t mission_id) {
  return [mission_id](const View& view, const Outset& outset) -> std::optional<Ending> {
    const msg::MissionStatus& mission = view.mission.message;
    if (mission.mission_id() != mission_id) return std::nullopt;
    const bool completed = mission.state() == msg::MissionStatus_Constants::COMPLETED;
    if (!completed && mission.state() != msg::MissionStatus_Constants::ABORTED) return std::nullopt;
    if (view.mission.count <= outset.missions)
      return std::nullopt;  // of the time before it was started again
    if (completed) return kCompleted;
    return Ending{Ending::Kind::kInterrupted, std::string("aborted: ") + mission.reason().c_str()};
  };
}

Manoeuvre::Manoeuvre(std::shared_ptr<const Course> course) : course_(std::move(course)) {}

const Answer& Manoeuvre::answer() const { return course_->answer; }

Ending Manoeuvre::wait(std::chrono::milliseconds timeout) const {
  if (!accepted()) return {Ending::Kind::kNotAccepted, answer().reason};
  const auto begin = Clock::now();
  const auto deadline = begin + timeout;
  while (true) {
    std::optional<Ending> ending;
    bool silent = false;
    const auto ended = [&](const View& view) {
      const auto heard = std::max(view.control.received, begin);
      silent = Clock::now() - heard > kSilence;
      ending = course_->judge(view, course_->outset);
      return ending || silent;
    };
    course_->client->wait(kLookPeriod, ended);
    if (ending) return *ending;
    if (silent) {
      return {Ending::Kind::kInterrupted,
              "nothing was heard for 3 s from the control service of " + course_->client->where()};
    }
    if (Clock::now() < deadline) continue;
    const double waited_s = std::chrono::duration<double>(timeout).count();
    char text[64];
    std::snprintf(text, sizeof text, "not done after %.1f s", waited_s);
    return {Ending::Kind::kTimedOut, text};
  }
}

std::future<Ending> Manoeuvre::future(std::chrono::milliseconds timeout) const {
  return std::async(std::launch::async, [manoeuvre = *this, timeout] { return manoeuvre.wait(timeout); });
}

}  // namespace swiftlet::ground
