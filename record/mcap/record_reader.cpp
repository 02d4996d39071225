#include "swiftlet/record/mcap/record_reader.hpp"

#include <utility>

#include "swiftlet/io/byte_reader.hpp"

namespace swiftlet::mcap {
namespace {

using io::ByteReader;

ByteReader fields_of(ByteView content) { return {content.data, content.size, true}; }

ByteView rest_of(ByteReader& in) {
  const std::size_t size = in.rest();
  return {in.take(size), size};
}

std::string text_of(ByteReader& in, std::uint64_t size) {
  const std::uint8_t* const bytes = in.take(size);
  return bytes == nullptr ? "" : std::string(reinterpret_cast<const char*>(bytes), size);
}
std::string text_of(ByteReader& in) { return text_of(in, in.u32()); }

std::int64_t time_of(ByteReader& in) { return static_cast<std::int64_t>(in.u64()); }

// Makes in not ok() if a part of it is not.
template <class Map, class Read>
Map map_of(ByteReader& in, const Read& read) {
  Map values;
  ByteReader part = in.part(in.u32());
  while (part.ok() && part.rest() > 0) {
    auto key = read(part);
    values.insert(std::move(key));
  }
  if (!part.ok()) in.skip(in.rest() + 1);
  return values;
}

std::map<std::string, std::string> texts_of(ByteReader& in) {
  return map_of<std::map<std::string, std::string>>(in, [](ByteReader& part) {
    std::string key = text_of(part);
    std::string value = text_of(part);
    return std::pair(std::move(key), std::move(value));
  });
}

std::map<std::uint16_t, std::uint64_t> counts_of(ByteReader& in) {
  return map_of<std::map<std::uint16_t, std::uint64_t>>(in, [](ByteReader& part) {
    const std::uint16_t key = part.u16();
    return std::pair(key, part.u64());
  });
}

template <class Value>
std::optional<Value> checked(const ByteReader& in, Value value) {
  if (!in.ok()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<Record> first_record(ByteView bytes) {
  ByteReader in = fields_of(bytes);
  const std::uint8_t opcode = in.u8();
  const std::uint64_t length = in.u64();
  if (!in.ok() || length > in.rest()) return std::nullopt;
  return Record{static_cast<Opcode>(opcode),
                {in.data(), static_cast<std::size_t>(length)},
                kRecordHeaderBytes + static_cast<std::size_t>(length)};
}

std::optional<Header> to_header(ByteView content) {
  ByteReader in = fields_of(content);
  Header header;
  header.profile = text_of(in);
  header.library = text_of(in);
  return checked(in, std::move(header));
}

std::optional<Footer> to_footer(ByteView content) {
  ByteReader in = fields_of(content);
  Footer footer;
  footer.summary_start = in.u64();
  footer.summary_offset_start = in.u64();
  footer.summary_crc = in.u32();
  return checked(in, footer);
}

std::optional<Schema> to_schema(ByteView content) {
  ByteReader in = fields_of(content);
  Schema schema;
  schema.id = in.u16();
  schema.name = text_of(in);
  schema.encoding = text_of(in);
  schema.data = text_of(in);
  if (schema.id == 0) return std::nullopt;
  return checked(in, std::move(schema));
}

std::optional<Channel> to_channel(ByteView content) {
  ByteReader in = fields_of(content);
  Channel channel;
  channel.id = in.u16();
  channel.schema_id = in.u16();
  channel.topic = text_of(in);
  channel.message_encoding = text_of(in);
  channel.metadata = texts_of(in);
  return checked(in, std::move(channel));
}

std::optional<Message> to_message(ByteView content) {
  ByteReader in = fields_of(content);
  Message message;
  message.channel_id = in.u16();
  message.sequence = in.u32();
  message.log_time_ns = time_of(in);
  message.publish_time_ns = time_of(in);
  message.payload = rest_of(in);
  return checked(in, message);
}

std::optional<Chunk> to_chunk(ByteView content) {
  ByteReader in = fields_of(content);
  Chunk chunk;
  chunk.start_ns = time_of(in);
  chunk.end_ns = time_of(in);
  chunk.uncompressed_size = in.u64();
  chunk.uncompressed_crc = in.u32();
  chunk.compression = text_of(in);
  chunk.records.size = in.u64();
  chunk.records.data = in.take(chunk.records.size);
  return checked(in, std::move(chunk));
}

std::optional<ChunkIndex> to_chunk_index(ByteView content) {
  ByteReader in = fields_of(content);
  ChunkIndex index;
  index.start_ns = time_of(in);
  index.end_ns = time_of(in);
  index.offset = in.u64();
  index.length = in.u64();
  index.message_index_offsets = counts_of(in);
  index.message_index_length = in.u64();
  index.compression = text_of(in);
  index.compressed_size = in.u64();
  index.uncompressed_size = in.u64();
  return checked(in, std::move(index));
}

std::optional<Attachment> to_attachment(ByteView content) {
  ByteReader in = fields_of(content);
  Attachment attachment;
  attachment.log_time_ns = time_of(in);
  attachment.create_time_ns = time_of(in);
  attachment.name = text_of(in);
  attachment.media_type = text_of(in);
  attachment.data = text_of(in, in.u64());
  in.u32();
  return checked(in, std::move(attachment));
}

std::optional<AttachmentIndex> to_attachment_index(ByteView content) {
  ByteReader in = fields_of(content);
  AttachmentIndex index;
  index.offset = in.u64();
  index.length = in.u64();
  index.log_time_ns = time_of(in);
  index.create_time_ns = time_of(in);
  index.data_size = in.u64();
  index.name = text_of(in);
  index.media_type = text_of(in);
  return checked(in, std::move(index));
}

std::optional<std::uint64_t> to_metadata_offset(ByteView content) {
  ByteReader in = fields_of(content);
  const std::uint64_t offset = in.u64();
  return checked(in, offset);
}

std::optional<Metadata> to_metadata(ByteView content) {
  ByteReader in = fields_of(content);
  Metadata metadata;
  metadata.name = text_of(in);
  metadata.values = texts_of(in);
  return checked(in, std::move(metadata));
}

std::optional<Statistics> to_statistics(ByteView content) {
  ByteReader in = fields_of(content);
  Statistics statistics;
  statistics.message_count = in.u64();
  statistics.schema_count = in.u16();
  statistics.channel_count = in.u32();
  statistics.attachment_count = in.u32();
  statistics.metadata_count = in.u32();
  statistics.chunk_count = in.u32();
  statistics.start_ns = time_of(in);
  statistics.end_ns = time_of(in);
  statistics.messages_by_channel = counts_of(in);
  return checked(in, std::move(statistics));
}

std::optional<std::uint32_t> to_data_crc(ByteView content) {
  ByteReader in = fields_of(content);
  const std::uint32_t crc = in.u32();
  return checked(in, crc);
}

}  // namespace swiftlet::mcap
