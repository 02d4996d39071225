// What `swiftlet watch` shows, as lines of text for a screen of a given size.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "swiftlet/ground/client/client.hpp"

namespace swiftlet::ground {

enum class Emphasis : std::uint8_t { kPlain, kHeading, kGood, kWarning };

struct ScreenLine {
  std::string text;  // of one column a character
  Emphasis emphasis = Emphasis::kPlain;
};

// What is shown besides the view: rates over the last second, and what the user was told.
struct WatchFacts {
  std::string vehicle;
  int domain = 0;
  std::string where;  // Client::no_control(), while no controller is heard
  double estimate_hz = 0.0;
  double pose_hz = 0.0;
  double battery_hz = 0.0;
  std::string message;  // the answer to the last key, or what a key asks
};

// What stands against a quiet flight, worst first, each as a few words: "battery is low: 3.25 V, below 3.30 V".
// Of what the battery must have, the vehicle's own control settings say; "(assumed)" if they have not been told.
std::vector<std::string> warnings_of(const View& view, Clock::time_point now);

// At most `height` lines of at most `width` characters: what matters most stays when the screen is small. The
// last line is the keys' or the message.
std::vector<ScreenLine> watch_screen(const View& view, const WatchFacts& facts, Clock::time_point now,
                                     int width, int height);

// All of it on one line, for output that is no terminal.
std::string watch_line(const View& view, const WatchFacts& facts, Clock::time_point now);

}  // namespace swiftlet::ground
