// A generated type support that outlives what is not of its type.
#pragma once

#include <cstdio>
#include <exception>
#include <mutex>

#include <fastdds/rtps/common/SerializedPayload.h>

#include "swiftlet/services/dds/throttled_warning.hpp"

namespace swiftlet::comms {

// Generated code of Fast DDS 2.9 lets exceptions of the decoder through, of which a byte other than 0 or 1 in
// a boolean is enough; in a thread of the middleware they would end the process. Here such a sample is
// dropped, with a line in the log.
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
    std::snprintf(fault.text, sizeof fault.text, "the bytes are no message of this type: %s", what);
    const std::lock_guard<std::mutex> lock(mutex_);
    log_.note(fault);
  }

  std::mutex mutex_;  // samples are taken by several threads
  ThrottledWarning log_{this->getName()};
};

}  // namespace swiftlet::comms
