// Messages as bytes, with the functions of either version of Fast DDS.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::tests {

using Payload = comms::rtps::SerializedPayload_t;

// The message as it is sent, with its encapsulation.
template <class PubSubType>
std::vector<unsigned char> serialized(typename PubSubType::type message) {
  PubSubType type;
#if SWIFTLET_FAST_DDS_3
  constexpr auto kCdr = eprosima::fastdds::dds::XCDR_DATA_REPRESENTATION;
  Payload payload(type.calculate_serialized_size(&message, kCdr));
  type.serialize(&message, payload, kCdr);
#else
  Payload payload(type.getSerializedSizeProvider(&message)());
  type.serialize(&message, &payload);
#endif
  return {payload.data, payload.data + payload.length};
}

// False if they are no message of this type.
inline bool deserialize(eprosima::fastdds::dds::TopicDataType& type, const std::uint8_t* bytes,
                        std::size_t size, void* message) {
  Payload payload(static_cast<std::uint32_t>(size));
  payload.length = static_cast<std::uint32_t>(size);
  std::copy_n(bytes, size, payload.data);
#if SWIFTLET_FAST_DDS_3
  return type.deserialize(payload, message);
#else
  return type.deserialize(&payload, message);
#endif
}

// Poses as another type by name and sends raw bytes.
class RawType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  using Bytes = std::vector<unsigned char>;

#if SWIFTLET_FAST_DDS_3
  using Representation = eprosima::fastdds::dds::DataRepresentationId_t;

  explicit RawType(const std::string& name) {
    set_name(name);
    max_serialized_type_size = kLargest;
  }
  bool serialize(const void* data, Payload& payload, Representation) override { return fill(data, payload); }
  bool deserialize(Payload&, void*) override { return false; }
  std::uint32_t calculate_serialized_size(const void* data, Representation) override { return size(data); }
  void* create_data() override { return new Bytes; }
  void delete_data(void* data) override { delete static_cast<Bytes*>(data); }
  bool compute_key(Payload&, comms::rtps::InstanceHandle_t&, bool) override { return false; }
  bool compute_key(const void*, comms::rtps::InstanceHandle_t&, bool) override { return false; }
#else
  explicit RawType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = kLargest;
  }
  bool serialize(void* data, Payload* payload) override { return fill(data, *payload); }
  bool deserialize(Payload*, void*) override { return false; }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return size(data); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, comms::rtps::InstanceHandle_t*, bool) override { return false; }
#endif

 private:
  static constexpr std::uint32_t kLargest = 65000;

  static std::uint32_t size(const void* data) {
    return static_cast<std::uint32_t>(static_cast<const Bytes*>(data)->size());
  }
  static bool fill(const void* data, Payload& payload) {
    const Bytes& bytes = *static_cast<const Bytes*>(data);
    payload.length = size(data);
    std::copy(bytes.begin(), bytes.end(), payload.data);
    return true;
  }
};

}  // namespace swiftlet::tests
