// A generated type support that drops malformed payloads.
#pragma once

#include <cstdio>
#include <exception>
#include <mutex>

#include <fastdds/rtps/common/SerializedPayload.h>

#include "swiftlet/services/dds/throttled_warning.hpp"

namespace swiftlet::comms {

// Generated code of Fast DDS 2.9 does not catch the exceptions of the decoder. A byte other than 0 or 1 in a
// boolean is enough to throw one, and in a middleware thread it would end the process. This class drops such
// a sample and logs a line.
template <class PubSubType>
class CheckedTypeSupport final : public PubSubType {
 public:
  using Payload = eprosima::fastrtps::rtps::SerializedPayload_t;

  bool deserialize(Payload* payload, void* data) override {
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
  ThrottledWarning log_{this->getName()};
};

}  // namespace swiftlet::comms
