// A terminal that shows a screen of lines and gives keys.
#pragma once

#include <optional>
#include <vector>

#include "swiftlet/ground/terminal/watch_screen.hpp"

namespace swiftlet::ground {

// One at a time. The terminal is as it was when it is destroyed.
class TerminalScreen {
 public:
  TerminalScreen();  // throws std::runtime_error if the terminal is of a kind that cannot do it
  ~TerminalScreen();
  TerminalScreen(const TerminalScreen&) = delete;
  TerminalScreen& operator=(const TerminalScreen&) = delete;

  int width() const;
  int height() const;
  void show(const std::vector<ScreenLine>& lines);

  static constexpr int kResized = -1;
  static constexpr int kEscape = 27;
  // The next key within the time, kResized when the terminal's size has changed; nothing otherwise.
  std::optional<int> key(int within_ms);

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace swiftlet::ground
