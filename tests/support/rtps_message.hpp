// Builds RTPS datagrams for tests, valid and invalid ones. Little endian.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "swiftlet/io/byte_writer.hpp"
#include "swiftlet/services/rtps/rtps_ids.hpp"

namespace swiftlet::tests {

using Bytes = std::vector<std::uint8_t>;

// Appends to a string of bytes.
class ByteWriter {
 public:
  ByteWriter& u8(unsigned value) { return integer(static_cast<std::uint8_t>(value)); }
  ByteWriter& u16(unsigned value) { return integer(static_cast<std::uint16_t>(value)); }
  ByteWriter& u32(std::uint32_t value) { return integer(value); }
  ByteWriter& number(std::uint32_t high, std::uint32_t low) {
    return u32(high).u32(low);
  }  // a sequence number
  ByteWriter& zeros(std::size_t count) { return bytes(Bytes(count)); }
  template <class Container>
  ByteWriter& bytes(const Container& more) {
    for (const auto byte : more) bytes_.push_back(static_cast<std::uint8_t>(byte));
    return *this;
  }
  // With its length and the terminating 0, padded to a multiple of 4.
  ByteWriter& string(const std::string& text) {
    u32(static_cast<std::uint32_t>(text.size() + 1)).bytes(text);
    return zeros(4 - text.size() % 4);
  }
  ByteWriter& parameter(unsigned id, const ByteWriter& value) {
    return u16(id).u16(static_cast<unsigned>(value.bytes_.size())).bytes(value.bytes_);
  }
  ByteWriter& sentinel() { return u32(1); }

  const Bytes& take() const { return bytes_; }

 private:
  template <class Integer>
  ByteWriter& integer(Integer value) {
    io::append(bytes_, value);
    return *this;
  }

  Bytes bytes_;
};

constexpr rtps::GuidPrefix kAlice{0x01, 0x0f, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
constexpr rtps::GuidPrefix kBob{0x01, 0x0f, 1, 2, 3, 4, 5, 6, 7, 8, 9, 11};

constexpr rtps::EntityId kSpdpWriter{0x00, 0x01, 0x00, 0xc2};
constexpr rtps::EntityId kSpdpReader{0x00, 0x01, 0x00, 0xc7};
constexpr rtps::EntityId kSedpWriter{0x00, 0x00, 0x03, 0xc2};
constexpr rtps::EntityId kSedpReader{0x00, 0x00, 0x03, 0xc7};
constexpr rtps::EntityId kUserWriter{0x00, 0x00, 0x01, 0x03};
constexpr rtps::EntityId kUserReader{0x00, 0x00, 0x02, 0x04};

class RtpsMessage {
 public:
  explicit RtpsMessage(const rtps::GuidPrefix& source = kAlice) {
    bytes_.bytes(std::string("RTPS")).u8(2).u8(3).u8(0x01).u8(0x0f).bytes(source);
  }
  // length: as the header states it; by default the length of the body.
  RtpsMessage& add(unsigned kind, unsigned flags, const ByteWriter& body, int length = -1) {
    const Bytes& content = body.take();
    bytes_.u8(kind)
        .u8(flags | 1U)
        .u16(length < 0 ? static_cast<unsigned>(content.size()) : static_cast<unsigned>(length));
    bytes_.bytes(content);
    return *this;
  }
  const Bytes& bytes() const { return bytes_.take(); }

 private:
  ByteWriter bytes_;
};

// The fields of DATA before its inline QoS.
inline ByteWriter data_fields(const rtps::EntityId& reader, const rtps::EntityId& writer,
                              std::uint32_t number, unsigned octets_to_inline_qos = 16) {
  ByteWriter out;
  out.u16(0).u16(octets_to_inline_qos).bytes(reader).bytes(writer).number(0, number);
  return out;
}

// The fields of DATA_FRAG before its inline QoS.
inline ByteWriter fragment_fields(std::uint32_t first, unsigned count, unsigned size, std::uint32_t sample) {
  ByteWriter out;
  out.u16(0)
      .u16(28)
      .bytes(kUserReader)
      .bytes(kUserWriter)
      .number(0, 1)
      .u32(first)
      .u16(count)
      .u16(size)
      .u32(sample);
  return out;
}

inline ByteWriter guid(const rtps::GuidPrefix& prefix, const rtps::EntityId& entity) {
  ByteWriter out;
  out.bytes(prefix).bytes(entity);
  return out;
}

inline ByteWriter lease(std::uint32_t seconds) {
  ByteWriter out;
  out.u32(seconds).u32(0);
  return out;
}

// The parameters of an announcement that every participant sends, without the end of the list.
inline ByteWriter participant_parameters(const rtps::GuidPrefix& participant, std::uint32_t lease_s = 20) {
  ByteWriter out;
  out.u16(0x0300).u16(0);  // PL_CDR_LE
  out.parameter(0x0015, ByteWriter().u32(0x0302)).parameter(0x0016, ByteWriter().u32(0x0f01));
  out.parameter(0x0050, guid(participant, rtps::kParticipantEntity)).parameter(0x0002, lease(lease_s));
  return out;
}

inline RtpsMessage announcement(const rtps::GuidPrefix& source, ByteWriter parameters) {
  ByteWriter body = data_fields(kSpdpReader, kSpdpWriter, 1);
  body.bytes(parameters.sentinel().take());
  return RtpsMessage(source).add(0x15, 4, body);
}

}  // namespace swiftlet::tests
