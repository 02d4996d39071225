// What a vehicle was asked to do: first it is answered, then, if it was accepted, it is done or ends
// otherwise.
#pragma once

#include <chrono>
#include <future>
#include <memory>
#include <string>

#include "swiftlet/ground/client/answer.hpp"

namespace swiftlet::ground {

// How a manoeuvre ended.
struct Ending {
  enum class Kind {
    kCompleted,
    kNotAccepted,  // it was never begun
    kInterrupted,  // by a failsafe, by somebody else's request, or by silence of the controller
    kTimedOut,     // it goes on, for longer than was waited
  };
  Kind kind = Kind::kTimedOut;
  std::string reason;  // a sentence unless done

  bool done() const { return kind == Kind::kCompleted; }
};

// A handle that may be copied and outlive the Vehicle that gave it. Any thread may call it.
class Manoeuvre {
 public:
  struct Course;  // of what is waited for
  explicit Manoeuvre(std::shared_ptr<const Course> course);

  const Answer& answer() const;
  bool accepted() const { return answer().accepted(); }

  // Returns when it has ended, or after the time-out; at once if it was not accepted.
  Ending wait(std::chrono::milliseconds timeout = std::chrono::seconds(60)) const;
  // The same in a thread of its own, for a program that has other things to do.
  std::future<Ending> future(std::chrono::milliseconds timeout = std::chrono::seconds(60)) const;

 private:
  std::shared_ptr<const Course> course_;
};

}  // namespace swiftlet::ground
