// A small MCAP file for tests.
#pragma once

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/record/mcap/reader.hpp"
#include "swiftlet/record/mcap/writer.hpp"

namespace swiftlet::tests {

// A message with its own payload.
struct KeptMessage {
  std::string topic;
  std::uint32_t sequence = 0;
  std::int64_t log_time_ns = 0;
  std::int64_t publish_time_ns = 0;
  std::string payload;

  bool operator==(const KeptMessage& other) const {
    return topic == other.topic && sequence == other.sequence && log_time_ns == other.log_time_ns &&
           publish_time_ns == other.publish_time_ns && payload == other.payload;
  }
};

inline std::vector<KeptMessage> messages_of(const mcap::Reader& file, mcap::Selection selection = {}) {
  std::vector<KeptMessage> kept;
  mcap::Messages messages(file, std::move(selection));
  while (messages.next()) {
    const mcap::Message& message = messages.message();
    kept.push_back({messages.channel().topic, message.sequence, message.log_time_ns, message.publish_time_ns,
                    std::string(reinterpret_cast<const char*>(message.payload.data), message.payload.size)});
  }
  return kept;
}

inline mcap::ByteView view_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

inline std::string file_content(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Message i of the file: on channel i % 2 at (i + 1) us.
inline KeptMessage nth_message(int i) {
  return {i % 2 == 0 ? "/kl1/imu" : "/kl1/battery", static_cast<std::uint32_t>(i), 1000 * (i + 1),
          1000 * (i + 1) - 300,
          std::string(static_cast<std::size_t>(20 + i % 7), static_cast<char>('a' + i % 26))};
}

// Adds the definitions of both channels, metadata and an attachment.
inline void begin_file(mcap::Writer& file) {
  const std::uint16_t imu = file.add_schema("test_msgs/msg/Imu", "ros2msg", "float64 x");
  file.add_channel("/kl1/imu", imu, "cdr", {{"kind", "stream"}});
  file.add_channel("/kl1/battery", file.add_schema("test_msgs/msg/Battery", "ros2msg", "float64 v"), "cdr",
                   {});
  file.write(mcap::Metadata{"flight", {{"seed", "7"}, {"mission", "square"}}});
  file.write(mcap::Attachment{5, 6, "vehicle.yaml", "application/yaml", "name: kl1\n"});
}

inline void write_message(mcap::Writer& file, int i) {
  const KeptMessage message = nth_message(i);
  file.write(mcap::Message{static_cast<std::uint16_t>(i % 2), message.sequence, message.log_time_ns,
                           message.publish_time_ns, view_of(message.payload)});
}

// Chunks of about 4 messages.
inline mcap::WriterSettings small_chunks(mcap::Compression compression) {
  mcap::WriterSettings settings;
  settings.library = "test";
  settings.compression = compression;
  settings.chunk_bytes = 200;
  return settings;
}

inline void write_file(const std::string& path, int count,
                       mcap::Compression compression = mcap::Compression::kZstd) {
  mcap::Writer file(path, small_chunks(compression));
  begin_file(file);
  for (int i = 0; i < count; ++i) write_message(file, i);
  file.close();
}

}  // namespace swiftlet::tests
