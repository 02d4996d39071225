// A generated type support that drops malformed payloads.
#pragma once

#include <cstdio>
#include <exception>
#include <mutex>

#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/throttled_warning.hpp"

namespace swiftlet::comms {

// Generated code does not catch all exceptions of the decoder. A byte other than 0 or 1 in a
// boolean is enough to throw one, and in a middleware thread it would end the process. This class drops such
// a sample and logs a line.
template <class PubSubType>
class CheckedTypeSupport final : public PubSubType {
 public:
  bool deserialize(PayloadArgument payload, void* data) override {
    try {
      if (PubSubType::deserialize(payload, data)) return true;
      note("it is too short");
    } catch (const std::exception& error) {
      note(error.what());
    }
    return false;
  }

 private:
  void note(const char* what) {
    Fault fault;
    std::snprintf(fault.text, sizeof fault.text, "the payload is not a message of this type: %s", what);
    const std::lock_guard<std::mutex> lock(mutex_);
    log_.note(fault);
  }

  std::mutex mutex_;  // several threads take samples
  ThrottledWarning log_{type_name(*this)};
};

}  // namespace swiftlet::comms
