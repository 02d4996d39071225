// Talks with the person at the vehicle: instructions to standard error, answers from the terminal.
#pragma once

#include <exception>
#include <functional>
#include <string>

namespace swiftlet::ground {

// Thrown when a signal ends the command.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

class OperatorDialog {
 public:
  // interrupted: returns true after a signal.
  explicit OperatorDialog(std::function<bool()> interrupted);

  bool has_terminal() const { return terminal_; }
  bool interrupted() const { return interrupted_(); }
  void require_going_on() const;  // throws Interrupted after a signal

  void say(const std::string& text) const;
  // Asks until the answer is one of `letters`; calls `meanwhile` at least every 100 ms. Needs a terminal. Throws
  // Interrupted.
  char ask(const std::string& question, const std::string& letters,
           const std::function<void()>& meanwhile) const;
  std::string ask_line(const std::string& question, const std::function<void()>& meanwhile) const;

 private:
  std::function<bool()> interrupted_;
  bool terminal_;
};

}  // namespace swiftlet::ground
