#include "swiftlet/io/mavlink/frame.hpp"

#include <algorithm>

#include "swiftlet/io/mavlink/crc.hpp"

namespace swiftlet::mavlink {

FrameBytes encode(const Frame& frame, std::uint8_t crc_extra) {
  std::size_t length = frame.length;
  while (length > 1 && frame.payload[length - 1] == 0) --length;
  const std::array<std::uint8_t, 10> header = {0xfd,
                                               static_cast<std::uint8_t>(length),
                                               0,  // no incompatible features: not signed
                                               0,
                                               frame.sequence,
                                               frame.system_id,
                                               frame.component_id,
                                               static_cast<std::uint8_t>(frame.message_id & 0xffU),
                                               static_cast<std::uint8_t>((frame.message_id >> 8U) & 0xffU),
                                               static_cast<std::uint8_t>((frame.message_id >> 16U) & 0xffU)};
  FrameBytes bytes;
  auto* end = std::copy(header.begin(), header.end(), bytes.data.begin());
  end = std::copy_n(frame.payload.begin(), length, end);
  Crc crc;
  crc.add(bytes.data.data() + 1, header.size() - 1 + length);
  crc.add(crc_extra);
  *end++ = static_cast<std::uint8_t>(crc.value() & 0xffU);
  *end++ = static_cast<std::uint8_t>(crc.value() >> 8U);
  bytes.size = header.size() + length + 2;
  return bytes;
}

}  // namespace swiftlet::mavlink
