// Where something that takes a while says how far it is.
#pragma once

#include <string>

namespace swiftlet::ground {

class Progress {
 public:
  virtual ~Progress() = default;

  // What stands now. stage: a change of it is worth telling of at once.
  virtual void update(int stage, const std::string& text) = 0;
  // A line that stays.
  virtual void say(const std::string& text) = 0;
};

}  // namespace swiftlet::ground
