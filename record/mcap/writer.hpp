// Writes an MCAP file (records.hpp) that is readable at any time up to its last chunk, also if the process is killed.
//
//   Writer file("flight.mcap", {});
//   const auto schema = file.add_schema("swiftlet_msgs/msg/Imu", "ros2msg", definition);
//   const auto channel = file.add_channel("/kl1/imu", schema, "cdr", {});
//   file.write({channel, sequence, log_time_ns, publish_time_ns, payload});
//   file.close();
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/record/mcap/compression.hpp"
#include "swiftlet/record/mcap/records.hpp"

namespace swiftlet::mcap {

struct WriterSettings {
  std::string profile = "ros2";
  std::string library = "swiftlet";
  Compression compression = Compression::kZstd;
  std::size_t chunk_bytes = std::size_t{1} << 20;  // a chunk ends when it holds this many, uncompressed
};

// A failed write ends the file: it keeps all whole records, and each later call does nothing.
class Writer {
 public:
  // Creates the file, or truncates it. Throws std::runtime_error.
  Writer(std::filesystem::path file, WriterSettings settings);
  ~Writer();  // closes the file without its summary unless close() was called
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  // Throws std::runtime_error if the file has 65535 schemas.
  std::uint16_t add_schema(const std::string& name, const std::string& encoding, const std::string& data);
  // Throws std::runtime_error if the file has 65536 channels.
  std::uint16_t add_channel(const std::string& topic, std::uint16_t schema_id,
                            const std::string& message_encoding,
                            const std::map<std::string, std::string>& metadata);

  // All below throw std::runtime_error with a sentence if the file cannot be written.
  void write(const Message& message);  // goes to the file with the end of its chunk
  void write(const Metadata& metadata);
  void write(const Attachment& attachment);
  void flush();  // ends the chunk, and hands it to the system
  void close();  // writes summary and footer

  const Statistics& statistics() const { return statistics_; }
  std::uint64_t file_bytes() const { return position_; }

 private:
  struct ChannelState {
    Channel channel;
    std::vector<std::pair<std::int64_t, std::uint64_t>> index;  // log time and place in the chunk
  };
  struct MetadataPlace {
    std::string name;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
  };

  void end_chunk();
  void write_summary();
  void put(const Bytes& records);  // appends whole records to the file
  [[noreturn]] void fail(int error);

  std::filesystem::path path_;
  WriterSettings settings_;
  Compressor compressor_;
  int file_ = -1;
  std::uint64_t position_ = 0;
  std::uint32_t data_crc_ = 0;
  Bytes definitions_;  // schemas and channels that are not in the file yet
  Bytes chunk_;
  std::int64_t chunk_start_ns_ = 0;
  std::int64_t chunk_end_ns_ = 0;
  Bytes records_;  // what goes to the file next
  std::vector<Schema> schemas_;
  std::vector<ChannelState> channels_;
  std::vector<ChunkIndex> chunk_indexes_;
  std::vector<MetadataPlace> metadata_;
  std::vector<AttachmentIndex> attachments_;
  Statistics statistics_;
};

}  // namespace swiftlet::mcap
