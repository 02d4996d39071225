#include "swiftlet/io/mavlink/frame_parser.hpp"

#include <algorithm>
#include <optional>

#include "swiftlet/io/mavlink/crc.hpp"
#include "swiftlet/io/mavlink/messages.hpp"

namespace swiftlet::mavlink {
namespace {

constexpr std::uint8_t kStart1 = 0xfe;
constexpr std::uint8_t kStart2 = 0xfd;
constexpr std::size_t kHeader1 = 6;
constexpr std::size_t kHeader2 = 10;
constexpr std::size_t kChecksum = 2;
constexpr std::size_t kSignature = 13;
constexpr std::uint8_t kSigned = 0x01;  // the only known feature of the frame

Frame header_of(const std::uint8_t* bytes, bool second) {
  Frame frame;
  frame.version = second ? 2 : 1;
  frame.length = bytes[1];
  const std::uint8_t* ids = bytes + (second ? 4 : 2);
  frame.sequence = ids[0];
  frame.system_id = ids[1];
  frame.component_id = ids[2];
  frame.message_id = ids[3];
  if (second)
    frame.message_id |= static_cast<std::uint32_t>(ids[4]) << 8U | static_cast<std::uint32_t>(ids[5]) << 16U;
  return frame;
}

}  // namespace

FrameParser::Step FrameParser::drop(std::size_t size) {
  std::copy(buffer_.begin() + static_cast<std::ptrdiff_t>(size),
            buffer_.begin() + static_cast<std::ptrdiff_t>(size_), buffer_.begin());
  size_ -= size;
  return Step::kDropped;
}

FrameParser::Step FrameParser::take() {
  if (size_ == 0) return Step::kWait;
  const bool second = buffer_[0] == kStart2;
  const std::uint8_t features = second && size_ > 2 ? buffer_[2] : 0;
  if ((!second && buffer_[0] != kStart1) || (features & ~kSigned) != 0) {
    ++counts_.skipped;
    return drop(1);
  }
  const std::size_t header = second ? kHeader2 : kHeader1;
  if (size_ < header) return Step::kWait;
  const std::size_t end = header + buffer_[1];
  const std::size_t total = end + kChecksum + (features == kSigned ? kSignature : 0);
  if (size_ < total) return Step::kWait;

  frame_ = header_of(buffer_.data(), second);
  const std::optional<std::uint8_t> extra = crc_extra_of(frame_.message_id);
  if (!extra) {
    ++counts_.unknown;
    return drop(total);
  }
  Crc crc;
  crc.add(buffer_.data() + 1, end - 1);
  crc.add(*extra);
  if (buffer_[end] != (crc.value() & 0xffU) || buffer_[end + 1] != crc.value() >> 8U) {
    ++counts_.wrong_checksum;
    ++counts_.skipped;
    return drop(1);
  }
  std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(header), frame_.length, frame_.payload.begin());
  ++counts_.frames;
  drop(total);
  return Step::kFrame;
}

}  // namespace swiftlet::mavlink
