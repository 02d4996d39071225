// A program in a terminal of its own, of the kind xterm, and what that shows.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace swiftlet::tests {

class Terminal {
 public:
  Terminal(const std::string& name, std::vector<std::string> arguments, int width, int height);
  ~Terminal();
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void type(const std::string& keys);
  void signal(int number) const;
  // The program is told, as by a window that changes its size; the screen is empty until it draws anew.
  void resize(int width, int height);

  std::string line(int row);  // without the blanks at its end
  std::string text();         // all lines

  // Waits for the program's end; -1 if it does not come in time, 128 + signal if it was killed.
  int wait(std::chrono::milliseconds timeout);
  // The terminal's modes are those that the program found, and its normal screen is shown.
  bool is_as_before();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swiftlet::tests
