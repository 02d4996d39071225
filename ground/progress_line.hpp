// Progress on standard error: one line that is rewritten on a terminal, a line now and then elsewhere.
#pragma once

#include <chrono>
#include <limits>
#include <string>

namespace swiftlet::ground {

class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // What stands now, cut to the terminal's width. stage: a change of it is worth a line of its own where
  // lines cannot be rewritten.
  void update(int stage, const std::string& text);
  // A line that stays.
  void say(const std::string& text);
  // No more progress for now: what others print begins on a fresh line.
  void close();

 private:
  bool terminal_;
  bool line_open_ = false;
  int stage_ = std::numeric_limits<int>::min();
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace swiftlet::ground
