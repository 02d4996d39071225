// Encodes records of an MCAP file into a buffer.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "swiftlet/io/byte_writer.hpp"
#include "swiftlet/record/mcap/records.hpp"

namespace swiftlet::mcap {

class RecordWriter {
 public:
  explicit RecordWriter(Bytes& out) : out_(out) {}

  // Between begin() and end() stand the fields of one record.
  void begin(Opcode opcode);
  void end();

  RecordWriter& u8(std::uint8_t value) { return integer(value); }
  RecordWriter& u16(std::uint16_t value) { return integer(value); }
  RecordWriter& u32(std::uint32_t value) { return integer(value); }
  RecordWriter& u64(std::uint64_t value) { return integer(value); }
  RecordWriter& time(std::int64_t ns) { return integer(ns); }
  RecordWriter& text(std::string_view value);
  RecordWriter& texts(const std::map<std::string, std::string>& values);
  RecordWriter& counts(const std::map<std::uint16_t, std::uint64_t>& values);
  RecordWriter& bytes(ByteView value);

  // Whole records.
  void record(const Header& header);
  void record(const Schema& schema);
  void record(const Channel& channel);
  void record(const Message& message);
  void record(const ChunkIndex& index);
  void record(const Attachment& attachment);
  void record(const AttachmentIndex& index);
  void record(const Metadata& metadata);
  void record(const Statistics& statistics);

 private:
  template <class Integer>
  RecordWriter& integer(Integer value) {
    io::append(out_, value);
    return *this;
  }

  Bytes& out_;
  std::size_t begin_ = 0;  // of the open record
};

// CRC-32 of zlib, continued from `crc`, 0 at the start.
std::uint32_t crc32(ByteView bytes, std::uint32_t crc = 0);

}  // namespace swiftlet::mcap
