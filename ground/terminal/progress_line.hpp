// Progress on standard error: one line that is rewritten on a terminal, a line now and then elsewhere.
#pragma once

#include <chrono>
#include <limits>
#include <string>

#include "swiftlet/ground/terminal/progress.hpp"

namespace swiftlet::ground {

class ProgressLine final : public Progress {
 public:
  ProgressLine();
  ~ProgressLine() override;
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // Cut to the terminal's width. A change of the stage is a line of its own where lines cannot be rewritten.
  void update(int stage, const std::string& text) override;
  void say(const std::string& text) override;
  // Characters that an update may have; 0: any number, where lines are not rewritten.
  std::size_t width() const;
  // No more progress for now: what others print begins on a fresh line.
  void close();

 private:
  bool terminal_;
  bool line_open_ = false;
  int stage_ = std::numeric_limits<int>::min();
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace swiftlet::ground
