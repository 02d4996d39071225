// The type support of a message that is handled as its payload.
#pragma once

#include <algorithm>
#include <cstdint>

#include "swiftlet/ground/ros/ros_messages.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::ros {

template <class Type>
class RawType : public dds::PayloadType {
 public:
  using type = Message<Type>;

  RawType() : PayloadType(Type::kName, kLongest) {}

 private:
  static constexpr std::uint32_t kLongest = 64000;  // payload that is handled, bytes

  void* create() override { return new type; }
  void destroy(void* message) override { delete static_cast<type*>(message); }
  std::uint32_t size(const void* message) const override {
    return static_cast<std::uint32_t>(static_cast<const type*>(message)->payload.size());
  }
  bool fill(const void* message, dds::fastrtps::SerializedPayload_t& payload) override {
    if (size(message) > payload.max_size) return false;
    const Bytes& bytes = static_cast<const type*>(message)->payload;
    payload.length = size(message);
    std::copy(bytes.begin(), bytes.end(), payload.data);
    return true;
  }
  bool take(const dds::fastrtps::SerializedPayload_t& payload, void* message) override {
    static_cast<type*>(message)->payload.assign(payload.data, payload.data + payload.length);
    return true;
  }
};

}  // namespace swiftlet::ros
