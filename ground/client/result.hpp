// The controller's answer to a request.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "swiftlet/control/types/request.hpp"

namespace swiftlet::ground {

struct Result {
  enum class Kind {
    kAccepted,
    kRefused,    // by the controller, see `reason`
    kNoControl,  // no controller was found
    kSilence,    // a controller was found and did not answer
    kCancelled,
  };
  Result() = default;
  Result(Kind kind_in, std::string reason_in, const control::RequestKey& key_in = {},
         std::int64_t stamp_ns_in = 0)
      : kind(kind_in), reason(std::move(reason_in)), key(key_in), stamp_ns(stamp_ns_in) {}

  Kind kind = Kind::kSilence;
  std::string reason;         // a sentence; if accepted, what to know about it, usually empty
  control::RequestKey key;    // of the request, if the controller answered
  std::int64_t stamp_ns = 0;  // if accepted: a control_status of a later stamp lists the request

  bool accepted() const { return kind == Kind::kAccepted; }
};

}  // namespace swiftlet::ground
