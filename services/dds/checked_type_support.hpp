// A generated type support that drops malformed payloads, and can hand out payloads as they came.
#pragma once

#include <cstdint>
#include <cstdio>
#include <exception>
#include <mutex>
#include <vector>

#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/throttled_warning.hpp"
#include "swiftlet/services/messages/wire_version.hpp"

namespace swiftlet::dds {

// What a reader takes a sample into: the message, or its payload with the encapsulation header, unchecked.
template <class T>
struct ReceivedSample {
  T message;
  bool raw = false;  // set by the reader: fill `payload` instead of `message`
  std::vector<std::uint8_t> payload;
};

// Generated code does not catch all exceptions of the decoder. A byte other than 0 or 1 in a
// boolean is enough to throw one, and in a middleware thread it would end the process. This class drops such
// a sample and logs a line. Readers take samples into a ReceivedSample. Of a message of another wire version only that is set; its payload is dropped too.
template <class PubSubType>
class CheckedTypeSupport final : public PubSubType {
 public:
  using Sample = ReceivedSample<typename PubSubType::type>;

  bool deserialize(PayloadArgument payload, void* data) override {
    Sample& sample = *static_cast<Sample*>(data);
    const fastrtps::SerializedPayload_t& bytes = content_of(payload);
    if constexpr (messages::StatesWireVersion<typename PubSubType::type>::value) {
      const auto version = messages::wire_version_of(bytes.data, bytes.length);
      if (version && *version != messages::kWireVersion) return take_foreign(*version, sample);
    }
    if (sample.raw) {
      sample.payload.assign(bytes.data, bytes.data + bytes.length);
      return true;
    }
    try {
      if (PubSubType::deserialize(payload, &sample.message)) return true;
      note("it is too short");
    } catch (const std::exception& error) {
      note(error.what());
    }
    return false;
  }

 private:
  bool take_foreign(std::uint32_t version, Sample& sample) {
    if (sample.raw) {
      note(messages::fault_of_wire_version(version, "its sender").c_str());
      return false;
    }
    sample.message = {};
    sample.message.wire_version(version);
    return true;
  }

  void note(const char* what) {
    messages::Fault fault;
    std::snprintf(fault.text, sizeof fault.text, "the payload is not a message of this type: %s", what);
    const std::lock_guard<std::mutex> lock(mutex_);
    log_.note(fault);
  }

  std::mutex mutex_;  // several threads take samples
  ThrottledWarning log_{type_name(*this)};
};

}  // namespace swiftlet::dds
