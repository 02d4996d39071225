// What a vehicle was asked to do: first it is answered, then, if it was accepted, it is done or ends
// otherwise. How far it is and how it ended is what the controller says in control_status.
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

// How a manoeuvre ended.
struct ActionResult {
  enum class Kind {
    kCompleted,
    kNotAccepted,  // it was never begun
    kCanceled,     // by a newer request, whoever asked for it, or by setpoints
    kAborted,      // by a failsafe
    kLost,         // nothing more is heard of it: the controller is silent, or was started again
    kTimedOut,     // it goes on, for longer than was waited
  };
  Kind kind = Kind::kTimedOut;
  std::string reason;  // a sentence unless done

  bool done() const { return kind == Kind::kCompleted; }
};

// The request's place in a status; null if it is not there.
const swiftlet_msgs::msg::RequestStatus* find_request(const swiftlet_msgs::msg::ControlStatus& status,
                                                      const control::RequestKey& key);

// How it ended; nothing while it is under way.
std::optional<ActionResult> action_result_of(const swiftlet_msgs::msg::RequestStatus& request);

// How an accepted request ended, by a status; nothing while it is under way, or where the status is older than
// its answer.
std::optional<ActionResult> action_result_by(const swiftlet_msgs::msg::ControlStatus& status,
                                             const Result& answer);

// A handle that may be copied and outlive the Vehicle that gave it. Any thread may call it.
class ActionHandle {
 public:
  ActionHandle(std::shared_ptr<const Client> client, Result answer);

  const Result& answer() const { return answer_; }
  bool accepted() const { return answer_.accepted(); }

  // 0 .. 1, as told last: of a take-off's or landing's height, of a way's time, of a mission's items, of a
  // trajectory's segments.
  double progress() const;

  // Returns when it has ended, or after the time-out; at once if it was not accepted.
  ActionResult wait(std::chrono::milliseconds timeout = std::chrono::seconds(60)) const;
  // The same in a thread of its own, for a program that has other things to do.
  std::future<ActionResult> future(std::chrono::milliseconds timeout = std::chrono::seconds(60)) const;

 private:
  std::shared_ptr<const Client> client_;
  Result answer_;
};

}  // namespace swiftlet::ground
