// Messages as bytes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::tests {

using Payload = dds::fastrtps::SerializedPayload_t;

// The message as it is sent, with its encapsulation.
template <class PubSubType>
std::vector<unsigned char> serialized(typename PubSubType::type message) {
  PubSubType type;
  Payload payload(dds::serialized_size(type, &message));
  dds::serialize(type, &message, payload);
  return {payload.data, payload.data + payload.length};
}

// False if they are no message of this type.
inline bool deserialize(eprosima::fastdds::dds::TopicDataType& type, const std::uint8_t* bytes,
                        std::size_t size, void* message) {
  Payload payload(static_cast<std::uint32_t>(size));
  payload.length = static_cast<std::uint32_t>(size);
  std::copy_n(bytes, size, payload.data);
  return dds::deserialize(type, payload, message);
}

// Poses as another type by name and sends raw bytes.
class RawType final : public dds::PayloadType {
 public:
  using Bytes = std::vector<unsigned char>;

  explicit RawType(const std::string& name) : PayloadType(name, kLargest) {}

 private:
  static constexpr std::uint32_t kLargest = 65000;

  void* create() override { return new Bytes; }
  void destroy(void* bytes) override { delete static_cast<Bytes*>(bytes); }
  std::uint32_t size(const void* bytes) const override {
    return static_cast<std::uint32_t>(static_cast<const Bytes*>(bytes)->size());
  }
  bool fill(const void* message, Payload& payload) override {
    const Bytes& bytes = *static_cast<const Bytes*>(message);
    payload.length = size(message);
    std::copy(bytes.begin(), bytes.end(), payload.data);
    return true;
  }
  bool take(const Payload&, void*) override { return false; }
};

}  // namespace swiftlet::tests
