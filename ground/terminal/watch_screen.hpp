// The screen of `swiftlet watch` as lines of text for a given size.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "swiftlet/ground/client/client.hpp"

namespace swiftlet::ground {

enum class Emphasis : std::uint8_t { kPlain, kHeading, kGood, kWarning };

// At most `columns` characters of UTF-8 text. A text that is longer ends with kCut instead.
constexpr const char* kCut = "\u2026";
std::string cut_to(const std::string& text, std::size_t columns);

// A line of text, and on a wide screen a second text from kRightColumn on. One column per character.
constexpr int kRightColumn = 60;
struct ScreenLine {
  std::string text;
  Emphasis emphasis = Emphasis::kPlain;
  std::string right_text{};
  Emphasis right_emphasis = Emphasis::kPlain;
};

// Data shown in addition to the view: rates over the last second and the last message to the user.
struct WatchFacts {
  std::string vehicle;
  int domain = 0;
  std::string where;  // Client::no_control(); used while no controller is connected
  double estimate_hz = 0.0;
  double pose_hz = 0.0;
  double battery_hz = 0.0;
  std::chrono::system_clock::time_point system_now;  // when the view is shown
  std::string message;  // result of the last key, or the question that it asks; empty: none
};

// Warnings besides silences_of(), most severe first, such as "battery is low: 3.25 V, below 3.30 V". The battery thresholds are
// those of the vehicle's control settings; "(assumed)" marks default thresholds, used if the vehicle does not
// publish its own.
std::vector<std::string> warnings_of(const View& view, Clock::time_point now);

// Returns `height` lines of at most `width` characters, the most important first, so that a small screen
// shows these: who is silent, mode, warnings. From kWideScreen columns on, the rest has two columns. The last
// lines show the keys or the message. If a line is left out, or cut on less than 80x24, the last line says so,
// from kNoteHeight lines on.
constexpr int kNoteHeight = 5;
constexpr int kWideScreen = 120;
std::vector<ScreenLine> watch_screen(const View& view, const WatchFacts& facts, Clock::time_point now,
                                     int width, int height);

// The same on one line, for output without a terminal.
std::string watch_line(const View& view, const WatchFacts& facts, Clock::time_point now);

}  // namespace swiftlet::ground
