// Runs a program in an emulated xterm and reads its screen.
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
  // Resizes the terminal and notifies the program; the screen is empty until it redraws.
  void resize(int width, int height);

  // Closes the terminal, as a window or connection that ends.
  void hang_up();

  std::string line(int row);  // without trailing blanks
  std::string text();         // all lines

  // Waits for the exit code; 128 + signal if killed; -1 after the timeout.
  int wait(std::chrono::milliseconds timeout);
  // Whether the terminal's modes are as at the start and its normal screen is shown.
  bool is_restored();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swiftlet::tests
