#include "swiftlet/record/mcap/record_writer.hpp"

#include <zlib.h>

namespace swiftlet::mcap {

void RecordWriter::begin(Opcode opcode) {
  u8(static_cast<std::uint8_t>(opcode));
  u64(0);  // end() knows the length
  begin_ = out_.size();
}

void RecordWriter::end() {
  const std::uint64_t length = out_.size() - begin_;
  io::store(length, out_.data() + begin_ - sizeof(length));
}

RecordWriter& RecordWriter::bytes(ByteView value) {
  out_.insert(out_.end(), value.data, value.data + value.size);
  return *this;
}

RecordWriter& RecordWriter::text(std::string_view value) {
  u32(static_cast<std::uint32_t>(value.size()));
  return bytes({reinterpret_cast<const std::uint8_t*>(value.data()), value.size()});
}

RecordWriter& RecordWriter::texts(const std::map<std::string, std::string>& values) {
  std::size_t length = 0;
  for (const auto& [key, value] : values) length += 8 + key.size() + value.size();
  u32(static_cast<std::uint32_t>(length));
  for (const auto& [key, value] : values) text(key).text(value);
  return *this;
}

RecordWriter& RecordWriter::counts(const std::map<std::uint16_t, std::uint64_t>& values) {
  u32(static_cast<std::uint32_t>(10 * values.size()));
  for (const auto& [key, value] : values) u16(key).u64(value);
  return *this;
}

void RecordWriter::record(const Header& header) {
  begin(Opcode::kHeader);
  text(header.profile).text(header.library);
  end();
}

void RecordWriter::record(const Schema& schema) {
  begin(Opcode::kSchema);
  u16(schema.id).text(schema.name).text(schema.encoding).text(schema.data);
  end();
}

void RecordWriter::record(const Channel& channel) {
  begin(Opcode::kChannel);
  u16(channel.id).u16(channel.schema_id).text(channel.topic).text(channel.message_encoding);
  texts(channel.metadata);
  end();
}

void RecordWriter::record(const Message& message) {
  begin(Opcode::kMessage);
  u16(message.channel_id).u32(message.sequence).time(message.log_time_ns).time(message.publish_time_ns);
  bytes(message.payload);
  end();
}

void RecordWriter::record(const ChunkIndex& index) {
  begin(Opcode::kChunkIndex);
  time(index.start_ns).time(index.end_ns).u64(index.offset).u64(index.length);
  counts(index.message_index_offsets).u64(index.message_index_length).text(index.compression);
  u64(index.compressed_size).u64(index.uncompressed_size);
  end();
}

void RecordWriter::record(const Attachment& attachment) {
  begin(Opcode::kAttachment);
  time(attachment.log_time_ns).time(attachment.create_time_ns).text(attachment.name);
  text(attachment.media_type).u64(attachment.data.size());
  bytes({reinterpret_cast<const std::uint8_t*>(attachment.data.data()), attachment.data.size()});
  u32(crc32({out_.data() + begin_, out_.size() - begin_}));
  end();
}

void RecordWriter::record(const AttachmentIndex& index) {
  begin(Opcode::kAttachmentIndex);
  u64(index.offset).u64(index.length).time(index.log_time_ns).time(index.create_time_ns);
  u64(index.data_size).text(index.name).text(index.media_type);
  end();
}

void RecordWriter::record(const Metadata& metadata) {
  begin(Opcode::kMetadata);
  text(metadata.name).texts(metadata.values);
  end();
}

void RecordWriter::record(const Statistics& statistics) {
  begin(Opcode::kStatistics);
  u64(statistics.message_count).u16(statistics.schema_count).u32(statistics.channel_count);
  u32(statistics.attachment_count).u32(statistics.metadata_count).u32(statistics.chunk_count);
  time(statistics.start_ns).time(statistics.end_ns).counts(statistics.messages_by_channel);
  end();
}

std::uint32_t crc32(ByteView bytes, std::uint32_t crc) {
  if (bytes.size == 0) return crc;  // zlib takes a null pointer for a new start
  return static_cast<std::uint32_t>(::crc32_z(crc, bytes.data, bytes.size));
}

}  // namespace swiftlet::mcap
