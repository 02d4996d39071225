// Decodes records of an MCAP file. Nothing is read beyond the given bytes.
#pragma once

#include <optional>

#include "swiftlet/record/mcap/records.hpp"

namespace swiftlet::mcap {

// A record at the start of some bytes.
struct Record {
  Opcode opcode{};
  ByteView content;      // without opcode and length
  std::size_t size = 0;  // with them
};

// nullopt if the bytes end before the record does.
std::optional<Record> first_record(ByteView bytes);

// The content of a chunk record.
struct Chunk {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;
  std::uint64_t uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;  // 0: not given
  std::string compression;
  ByteView records;  // compressed
};

struct Footer {
  std::uint64_t summary_start = 0;  // 0: no summary
  std::uint64_t summary_offset_start = 0;
  std::uint32_t summary_crc = 0;  // 0: not given
};

// nullopt if the content is not such a record. Fields that a later version may append are ignored.
std::optional<Header> to_header(ByteView content);
std::optional<Footer> to_footer(ByteView content);
std::optional<Schema> to_schema(ByteView content);
std::optional<Channel> to_channel(ByteView content);
std::optional<Message> to_message(ByteView content);
std::optional<Chunk> to_chunk(ByteView content);
std::optional<ChunkIndex> to_chunk_index(ByteView content);
std::optional<AttachmentIndex> to_attachment_index(ByteView content);
std::optional<Attachment> to_attachment(ByteView content);  // also if its CRC is wrong
std::optional<Metadata> to_metadata(ByteView content);
std::optional<std::uint64_t> to_metadata_offset(ByteView content);  // of a metadata index
std::optional<Statistics> to_statistics(ByteView content);
std::optional<std::uint32_t> to_data_crc(ByteView content);  // of the DataEnd record; 0: not given

}  // namespace swiftlet::mcap
