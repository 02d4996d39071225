// The handle and result of a request to a vehicle. The controller answers each request; an accepted one then
// executes until it completes, is canceled or is aborted. Progress and result come from control_status.
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "swiftlet/ground/client/result.hpp"

namespace swiftlet_msgs::msg {
class ControlStatus;
class RequestStatus;
}  // namespace swiftlet_msgs::msg

namespace swiftlet::ground {

class Client;

// The result of an action.
struct ActionResult {
  enum class Kind {
    kCompleted,
    kNotAccepted,  // refused or not answered; never started
    kCanceled,     // by a newer request of any client, or by setpoints
    kAborted,      // by a failsafe
    kLost,         // result unknown: the controller is silent or was restarted
    kTimedOut,     // still executing when the time-out of wait() ended
  };
  Kind kind = Kind::kTimedOut;
  std::string reason;  // a sentence; empty if done

  bool done() const { return kind == Kind::kCompleted; }
};

// The request's entry in `status`; null if the status does not list it.
const swiftlet_msgs::msg::RequestStatus* find_request(const swiftlet_msgs::msg::ControlStatus& status,
                                                      const control::RequestKey& key);

// The result of a request; nullopt while it executes.
std::optional<ActionResult> action_result_of(const swiftlet_msgs::msg::RequestStatus& request);

// The result of an accepted request according to `status`; nullopt while it executes, or if the status is
// older than the request's answer. kLost if a newer status does not list the request.
std::optional<ActionResult> action_result_by(const swiftlet_msgs::msg::ControlStatus& status,
                                             const Result& answer);

// What canceled a mission: "mission interrupted: another ground tool sent goto".
std::string interruption_by(const ActionResult& canceled);

// Copyable. May outlive the Vehicle that returned it. Thread-safe.
class ActionHandle {
 public:
  ActionHandle(std::shared_ptr<const Client> client, Result answer);

  const Result& answer() const { return answer_; }
  bool accepted() const { return answer_.accepted(); }

  // 0 .. 1, as last reported: the share of the height (take-off, landing), of the time (go-to), of the items
  // (mission) or of the segments (trajectory).
  double progress() const;

  // Blocks until the action ends or the time-out expires. Returns at once if it was not accepted. May be
  // called again after kTimedOut.
  ActionResult wait(std::chrono::milliseconds timeout = std::chrono::seconds(60)) const;
  // Runs wait() in a thread of its own.
  std::future<ActionResult> future(std::chrono::milliseconds timeout = std::chrono::seconds(60)) const;

 private:
  std::shared_ptr<const Client> client_;
  Result answer_;
  std::chrono::steady_clock::time_point answered_ = std::chrono::steady_clock::now();
};

}  // namespace swiftlet::ground
