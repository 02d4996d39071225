// The records of an MCAP file, as in its specification (https://mcap.dev/spec), version 0. Numbers are little-endian, a
// record is an opcode (1 byte), a length (8 bytes) and that many bytes. Times are ns of the clock of the file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace swiftlet::mcap {

using Bytes = std::vector<std::uint8_t>;

// Bytes that another object owns.
struct ByteView {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0a,
  kStatistics = 0x0b,
  kMetadata = 0x0c,
  kMetadataIndex = 0x0d,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

// The first and the last bytes of a file.
constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
constexpr std::size_t kRecordHeaderBytes = 9;
constexpr std::size_t kFooterBytes = 20;  // without its record header

struct Header {
  std::string profile;  // "ros2"
  std::string library;  // the writer
};

struct Schema {
  std::uint16_t id = 0;  // not 0
  std::string name;      // "swiftlet_msgs/msg/Imu"
  std::string encoding;  // "ros2msg"
  std::string data;
};

struct Channel {
  std::uint16_t id = 0;
  std::uint16_t schema_id = 0;   // 0: none
  std::string topic;             // "/kl1/imu"
  std::string message_encoding;  // "cdr"
  std::map<std::string, std::string> metadata;
};

struct Message {
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::int64_t log_time_ns = 0;      // when it was recorded
  std::int64_t publish_time_ns = 0;  // when it was sent
  ByteView payload;
};

struct ChunkIndex {
  std::int64_t start_ns = 0;  // least log time of its messages
  std::int64_t end_ns = 0;    // largest
  std::uint64_t offset = 0;   // of the chunk record in the file
  std::uint64_t length = 0;   // of the record with its header
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;
  std::uint64_t message_index_length = 0;  // of all message index records behind the chunk
  std::string compression;                 // "", "zstd", "lz4"
  std::uint64_t compressed_size = 0;
  std::uint64_t uncompressed_size = 0;
};

struct Attachment {
  std::int64_t log_time_ns = 0;
  std::int64_t create_time_ns = 0;
  std::string name;
  std::string media_type;
  std::string data;
};

struct AttachmentIndex {
  std::uint64_t offset = 0;  // of the attachment record in the file
  std::uint64_t length = 0;  // of the record with its header
  std::int64_t log_time_ns = 0;
  std::int64_t create_time_ns = 0;
  std::uint64_t data_size = 0;
  std::string name;
  std::string media_type;
};

struct Metadata {
  std::string name;
  std::map<std::string, std::string> values;
};

struct Statistics {
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0;
  std::uint32_t attachment_count = 0;
  std::uint32_t metadata_count = 0;
  std::uint32_t chunk_count = 0;
  std::int64_t start_ns = 0;  // least log time of a message; 0 without messages
  std::int64_t end_ns = 0;
  std::map<std::uint16_t, std::uint64_t> messages_by_channel;
};

}  // namespace swiftlet::mcap
