// The type support of a message that is handled as its payload.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>

#include "swiftlet/ground/ros/ros_messages.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::ros {

template <class Type>
class RawType : public eprosima::fastdds::dds::TopicDataType {
 public:
  using type = Message<Type>;

#if SWIFTLET_FAST_DDS_3
  using Representation = eprosima::fastdds::dds::DataRepresentationId_t;

  RawType() {
    set_name(Type::kName);
    max_serialized_type_size = kLongest;
  }
  bool serialize(const void* data, comms::rtps::SerializedPayload_t& payload, Representation) override {
    return fill(data, payload);
  }
  bool deserialize(comms::rtps::SerializedPayload_t& payload, void* data) override {
    return take(payload, data);
  }
  std::uint32_t calculate_serialized_size(const void* data, Representation) override { return size(data); }
  void* create_data() override { return new type; }
  void delete_data(void* data) override { delete static_cast<type*>(data); }
  bool compute_key(comms::rtps::SerializedPayload_t&, comms::rtps::InstanceHandle_t&, bool) override {
    return false;
  }
  bool compute_key(const void*, comms::rtps::InstanceHandle_t&, bool) override { return false; }
#else
  RawType() {
    setName(Type::kName);
    m_typeSize = kLongest;
  }
  bool serialize(void* data, comms::rtps::SerializedPayload_t* payload) override {
    return fill(data, *payload);
  }
  bool deserialize(comms::rtps::SerializedPayload_t* payload, void* data) override {
    return take(*payload, data);
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return size(data); };
  }
  void* createData() override { return new type; }
  void deleteData(void* data) override { delete static_cast<type*>(data); }
  bool getKey(void*, comms::rtps::InstanceHandle_t*, bool) override { return false; }
#endif

 private:
  static constexpr std::uint32_t kLongest = 64000;  // payload that is handled, bytes

  static std::uint32_t size(const void* data) {
    return static_cast<std::uint32_t>(static_cast<const type*>(data)->payload.size());
  }
  static bool fill(const void* data, comms::rtps::SerializedPayload_t& payload) {
    if (size(data) > payload.max_size) return false;
    const Bytes& bytes = static_cast<const type*>(data)->payload;
    payload.length = size(data);
    std::copy(bytes.begin(), bytes.end(), payload.data);
    return true;
  }
  static bool take(const comms::rtps::SerializedPayload_t& payload, void* data) {
    static_cast<type*>(data)->payload.assign(payload.data, payload.data + payload.length);
    return true;
  }
};

}  // namespace swiftlet::ros
