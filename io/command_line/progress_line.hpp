// Progress on standard error: one line that is overwritten on a terminal, otherwise a new line every 10 s.
#pragma once

#include <chrono>
#include <limits>
#include <string>

#include "swiftlet/io/command_line/progress.hpp"

namespace swiftlet::io {

class ProgressLine final : public Progress {
 public:
  ProgressLine();
  ~ProgressLine() override;
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // Cuts the text to the width of the terminal. Without a terminal a change of the stage prints a new line.
  void update(int stage, const std::string& text) override;
  void say(const std::string& text) override;
  // Longest update, characters; 0: no limit, because standard error is not a terminal.
  std::size_t width() const;
  // Ends the current progress line, so that other output begins on a new line.
  void close();

 private:
  bool terminal_;
  bool line_open_ = false;
  int stage_ = std::numeric_limits<int>::min();
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace swiftlet::io
