#include "swiftlet/record/file/message_file.hpp"

#include <array>
#include <chrono>
#include <unistd.h>
#include <utility>

namespace swiftlet::record {

mcap::Metadata recorder_metadata(RecordClock clock) {
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  const auto now = std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::system_clock::now().time_since_epoch());
  return {"swiftlet/recorder",
          {{"host", host.data()},
           {"started_ns", std::to_string(now.count())},
           {"time", clock == RecordClock::kVehicle ? "vehicle" : "wall"}}};
}

mcap::Metadata counts_metadata(const std::map<std::string, std::uint64_t>& counts) {
  mcap::Metadata metadata{kCountsMetadata, {}};
  for (const auto& [name, count] : counts) metadata.values[name] = std::to_string(count);
  return metadata;
}

MessageFile::MessageFile(std::filesystem::path file, mcap::WriterSettings settings, bool standard_messages)
    : file_(std::move(file), std::move(settings)), standard_messages_(standard_messages) {}

std::uint16_t MessageFile::add_channel(const std::string& vehicle, const char* topic,
                                       const messages::MessageSchema& schema) {
  const std::uint16_t id = file_.add_channel("/" + vehicle + "/" + topic, schema_in(schema), "cdr", {});
  sources_[id] = {&vehicles_.try_emplace(vehicle, vehicle).first->second, topic};
  return id;
}

void MessageFile::write(const mcap::Message& message) {
  file_.write(message);
  if (!standard_messages_) return;
  const Source& source = sources_.at(message.channel_id);
  for (const StandardMessage& follows : source.vehicle->of(source.topic, message)) {
    mcap::Message standard = message;
    standard.channel_id = standard_channel(follows);
    standard.payload = {follows.payload.data(), follows.payload.size()};
    file_.write(standard);
  }
}

void MessageFile::write(const StandardMessage& message, std::int64_t time_ns) {
  file_.write(mcap::Message{
      standard_channel(message), 0, time_ns, time_ns, {message.payload.data(), message.payload.size()}});
}

std::uint16_t MessageFile::schema_in(const messages::MessageSchema& schema) {
  const auto known = schemas_.find(&schema);
  if (known != schemas_.end()) return known->second;
  return schemas_[&schema] = file_.add_schema(schema.name, "ros2msg", schema.definition);
}

std::uint16_t MessageFile::standard_channel(const StandardMessage& message) {
  const auto known = standard_channels_.find(message.topic);
  if (known != standard_channels_.end()) return known->second;
  return standard_channels_[message.topic] =
             file_.add_channel(message.topic, schema_in(*message.schema), "cdr", {});
}

}  // namespace swiftlet::record
