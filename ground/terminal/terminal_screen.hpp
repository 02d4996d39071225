// Full-screen text output and key input on a terminal.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "swiftlet/ground/terminal/watch_screen.hpp"

namespace swiftlet::ground {

// At most one may exist at a time. The destructor restores the terminal.
class TerminalScreen {
 public:
  // Throws std::runtime_error if $TERM does not support full screen. instead: what to do then, for its text.
  explicit TerminalScreen(const std::string& instead = "use `swiftlet watch --plain`");
  ~TerminalScreen();
  TerminalScreen(const TerminalScreen&) = delete;
  TerminalScreen& operator=(const TerminalScreen&) = delete;

  int width() const;
  int height() const;
  void show(const std::vector<ScreenLine>& lines);

  static constexpr int kResized = -1;
  static constexpr int kUpArrow = -2;
  static constexpr int kDownArrow = -3;
  static constexpr int kLeftArrow = -4;
  static constexpr int kRightArrow = -5;
  static constexpr int kEscape = 27;
  // Waits for the next key. Returns kResized if the size of the terminal changed, nothing after within_ms.
  std::optional<int> key(int within_ms);

  // False once the terminal has been closed.
  bool is_open() const;

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace swiftlet::ground
