// An MCAP file of vehicles' messages: raw payloads with ROS 2 message definitions, and the standard messages that follow
// from them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "swiftlet/record/file/standard_messages.hpp"
#include "swiftlet/record/mcap/writer.hpp"
#include "swiftlet/services/messages/schemas.hpp"

namespace swiftlet::record {

// The times of the recorded messages.
enum class RecordClock {
  kWall,     // when they arrived, ns since 1970
  kVehicle,  // their stamps; of a message without one the newest stamp of its vehicle. For simulated time
};

// Metadata swiftlet/recorder: host, start, and the clock of the times.
mcap::Metadata recorder_metadata(RecordClock clock);

// Metadata swiftlet/counts, which a whole file has: messages received, dropped and lost, also of a topic ("lost /kl1/imu").
constexpr const char* kCountsMetadata = "swiftlet/counts";
mcap::Metadata counts_metadata(const std::map<std::string, std::uint64_t>& counts);

// All functions throw std::runtime_error as mcap::Writer does.
class MessageFile {
 public:
  // standard_messages: also write those of standard_messages.hpp.
  MessageFile(std::filesystem::path file, mcap::WriterSettings settings, bool standard_messages);

  // A channel for a topic of a vehicle, "/kl1/imu". topic: "imu", must outlive the file
  std::uint16_t add_channel(const std::string& vehicle, const char* topic,
                            const messages::MessageSchema& schema);
  void write(const mcap::Message& message);
  // Without a message of a vehicle. time_ns: of the log and of the publication
  void write(const StandardMessage& message, std::int64_t time_ns);
  void write(const mcap::Metadata& metadata) { file_.write(metadata); }
  void write(const mcap::Attachment& attachment) { file_.write(attachment); }
  void flush() { file_.flush(); }
  void close() { file_.close(); }
  std::uint64_t file_bytes() const { return file_.file_bytes(); }

 private:
  struct Source {
    StandardMessages* vehicle = nullptr;
    const char* topic = nullptr;
  };

  std::uint16_t schema_in(const messages::MessageSchema& schema);
  std::uint16_t standard_channel(const StandardMessage& message);

  mcap::Writer file_;
  const bool standard_messages_;
  std::map<const messages::MessageSchema*, std::uint16_t> schemas_;
  std::map<std::string, std::uint16_t> standard_channels_;  // by topic
  std::map<std::string, StandardMessages> vehicles_;
  std::map<std::uint16_t, Source> sources_;  // by channel
};

}  // namespace swiftlet::record
