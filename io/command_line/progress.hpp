// Interface to report the progress of a long operation.
#pragma once

#include <string>

namespace swiftlet::io {

class Progress {
 public:
  virtual ~Progress() = default;

  // Shows the current state. A change of `stage` is shown at once; other updates may be dropped.
  virtual void update(int stage, const std::string& text) = 0;
  // Prints a permanent line.
  virtual void say(const std::string& text) = 0;
};

}  // namespace swiftlet::io
