#include "swiftlet/services/dds/payload.hpp"

#include <algorithm>
#include <exception>

#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/message_types.hpp"

namespace swiftlet::dds {

template <class T>
std::vector<std::uint8_t> to_payload(const T& message) {
  typename PubSubTypeOf<T>::type type;
  T copy = message;  // Fast DDS 2.9 takes no constant one
  fastrtps::SerializedPayload_t payload(serialized_size(type, &copy));
  serialize(type, &copy, payload);
  return {payload.data, payload.data + payload.length};
}

template <class T>
bool from_payload(const std::uint8_t* bytes, std::size_t size, T& message) {
  typename PubSubTypeOf<T>::type type;
  fastrtps::SerializedPayload_t payload(static_cast<std::uint32_t>(size));
  payload.length = static_cast<std::uint32_t>(size);
  std::copy_n(bytes, size, payload.data);
  try {
    return deserialize(type, payload, &message);
  } catch (const std::exception&) {
    return false;  // generated code does not catch all exceptions of the decoder
  }
}

#define SWIFTLET_INSTANTIATE(Name, ...)                                      \
  template std::vector<std::uint8_t> to_payload(const messages::msg::Name&); \
  template bool from_payload(const std::uint8_t*, std::size_t, messages::msg::Name&);
SWIFTLET_FOR_EACH_MESSAGE(SWIFTLET_INSTANTIATE)
#undef SWIFTLET_INSTANTIATE

}  // namespace swiftlet::dds
