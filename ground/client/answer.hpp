// The answer to a request.
#pragma once

#include <string>

namespace swiftlet::ground {

struct Answer {
  enum class Kind {
    kAccepted,
    kRefused,    // by the controller, for `reason`
    kNoControl,  // no controller was there to take it
    kSilence,    // a controller was there and did not answer
    kCancelled,
  };
  Kind kind = Kind::kSilence;
  std::string reason;  // a sentence unless accepted

  bool accepted() const { return kind == Kind::kAccepted; }
};

}  // namespace swiftlet::ground
