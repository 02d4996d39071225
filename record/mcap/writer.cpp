#include "swiftlet/record/mcap/writer.hpp"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <limits>
#include <stdexcept>
#include <unistd.h>
#include <utility>

#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/record/mcap/record_writer.hpp"

namespace swiftlet::mcap {
namespace {

void extend(Statistics& statistics, std::int64_t log_time_ns) {
  const bool first = statistics.message_count == 0;
  statistics.start_ns = first ? log_time_ns : std::min(statistics.start_ns, log_time_ns);
  statistics.end_ns = first ? log_time_ns : std::max(statistics.end_ns, log_time_ns);
}

void put_offset(RecordWriter& out, Opcode group, std::uint64_t start, std::uint64_t end) {
  if (end == start) return;
  out.begin(Opcode::kSummaryOffset);
  out.u8(static_cast<std::uint8_t>(group)).u64(start).u64(end - start);
  out.end();
}

}  // namespace

Writer::Writer(std::filesystem::path file, WriterSettings settings)
    : path_(std::move(file)), settings_(std::move(settings)), compressor_(settings_.compression) {
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file_ < 0) throw std::runtime_error(io::write_fault(path_, errno));
  Bytes start(kMagic.begin(), kMagic.end());
  RecordWriter(start).record(Header{settings_.profile, settings_.library});
  put(start);
}

Writer::~Writer() {
  if (file_ >= 0) ::close(file_);
}

std::uint16_t Writer::add_schema(const std::string& name, const std::string& encoding,
                                 const std::string& data) {
  if (schemas_.size() == std::numeric_limits<std::uint16_t>::max())
    throw std::runtime_error(path_.string() + ": cannot hold more than 65535 schemas");
  schemas_.push_back({static_cast<std::uint16_t>(schemas_.size() + 1), name, encoding, data});
  RecordWriter(definitions_).record(schemas_.back());
  ++statistics_.schema_count;
  return schemas_.back().id;
}

std::uint16_t Writer::add_channel(const std::string& topic, std::uint16_t schema_id,
                                  const std::string& message_encoding,
                                  const std::map<std::string, std::string>& metadata) {
  if (channels_.size() > std::numeric_limits<std::uint16_t>::max())
    throw std::runtime_error(path_.string() + ": cannot hold more than 65536 channels");
  const auto id = static_cast<std::uint16_t>(channels_.size());
  channels_.push_back({{id, schema_id, topic, message_encoding, metadata}, {}});
  RecordWriter(definitions_).record(channels_.back().channel);
  ++statistics_.channel_count;
  return id;
}

void Writer::write(const Message& message) {
  if (file_ < 0) return;
  ChannelState& channel = channels_.at(message.channel_id);
  chunk_start_ns_ = chunk_.empty() ? message.log_time_ns : std::min(chunk_start_ns_, message.log_time_ns);
  chunk_end_ns_ = chunk_.empty() ? message.log_time_ns : std::max(chunk_end_ns_, message.log_time_ns);
  channel.index.emplace_back(message.log_time_ns, chunk_.size());
  RecordWriter(chunk_).record(message);
  extend(statistics_, message.log_time_ns);
  ++statistics_.message_count;
  ++statistics_.messages_by_channel[message.channel_id];
  if (chunk_.size() >= settings_.chunk_bytes) end_chunk();
}

void Writer::write(const Metadata& metadata) {
  if (file_ < 0) return;
  Bytes records;
  RecordWriter(records).record(metadata);
  metadata_.push_back({metadata.name, position_, records.size()});
  put(records);
  ++statistics_.metadata_count;
}

void Writer::write(const Attachment& attachment) {
  if (file_ < 0) return;
  Bytes records;
  RecordWriter(records).record(attachment);
  attachments_.push_back({position_, records.size(), attachment.log_time_ns, attachment.create_time_ns,
                          attachment.data.size(), attachment.name, attachment.media_type});
  put(records);
  ++statistics_.attachment_count;
}

void Writer::flush() { end_chunk(); }

void Writer::end_chunk() {
  if (file_ < 0) return;
  records_.swap(definitions_);
  definitions_.clear();
  const std::uint64_t chunk_at = position_ + records_.size();
  if (!chunk_.empty()) {
    const ByteView packed = compressor_.compress(chunk_);
    ChunkIndex index;
    index.start_ns = chunk_start_ns_;
    index.end_ns = chunk_end_ns_;
    index.offset = chunk_at;
    index.compression = to_string(settings_.compression);
    index.compressed_size = packed.size;
    index.uncompressed_size = chunk_.size();
    RecordWriter out(records_);
    out.begin(Opcode::kChunk);
    out.time(index.start_ns).time(index.end_ns).u64(chunk_.size());
    out.u32(crc32({chunk_.data(), chunk_.size()})).text(index.compression).u64(packed.size).bytes(packed);
    out.end();
    index.length = position_ + records_.size() - chunk_at;
    for (ChannelState& channel : channels_) {
      if (channel.index.empty()) continue;
      index.message_index_offsets[channel.channel.id] = position_ + records_.size();
      out.begin(Opcode::kMessageIndex);
      out.u16(channel.channel.id).u32(static_cast<std::uint32_t>(16 * channel.index.size()));
      for (const auto& [time_ns, place] : channel.index) out.time(time_ns).u64(place);
      out.end();
      channel.index.clear();
    }
    index.message_index_length = position_ + records_.size() - chunk_at - index.length;
    chunk_indexes_.push_back(std::move(index));
    ++statistics_.chunk_count;
    chunk_.clear();
  }
  put(records_);
}

void Writer::close() {
  if (file_ < 0) return;
  end_chunk();
  write_summary();
  const int closed = ::close(file_);
  file_ = -1;
  if (closed != 0) throw std::runtime_error(io::write_fault(path_, errno));
}

void Writer::write_summary() {
  Bytes bytes;
  RecordWriter out(bytes);
  out.begin(Opcode::kDataEnd);
  out.u32(data_crc_);
  out.end();
  const std::size_t summary = bytes.size();
  const auto here = [&] { return position_ + bytes.size(); };
  const std::uint64_t schemas_at = here();
  for (const Schema& schema : schemas_) out.record(schema);
  const std::uint64_t channels_at = here();
  for (const ChannelState& channel : channels_) out.record(channel.channel);
  const std::uint64_t statistics_at = here();
  out.record(statistics_);
  const std::uint64_t chunks_at = here();
  for (const ChunkIndex& index : chunk_indexes_) out.record(index);
  const std::uint64_t attachments_at = here();
  for (const AttachmentIndex& index : attachments_) out.record(index);
  const std::uint64_t metadata_at = here();
  for (const MetadataPlace& place : metadata_) {
    out.begin(Opcode::kMetadataIndex);
    out.u64(place.offset).u64(place.length).text(place.name);
    out.end();
  }
  const std::uint64_t offsets_at = here();
  put_offset(out, Opcode::kSchema, schemas_at, channels_at);
  put_offset(out, Opcode::kChannel, channels_at, statistics_at);
  put_offset(out, Opcode::kStatistics, statistics_at, chunks_at);
  put_offset(out, Opcode::kChunkIndex, chunks_at, attachments_at);
  put_offset(out, Opcode::kAttachmentIndex, attachments_at, metadata_at);
  put_offset(out, Opcode::kMetadataIndex, metadata_at, offsets_at);
  out.begin(Opcode::kFooter);
  out.u64(schemas_at).u64(offsets_at).u32(0);
  out.end();
  // The CRC covers summary and footer up to itself. It and the footer's length are known now.
  const std::size_t crc_at = bytes.size() - 4;
  std::uint32_t crc = crc32({bytes.data() + summary, crc_at - summary});
  for (std::size_t i = 0; i < 4; ++i, crc >>= 8U) bytes[crc_at + i] = static_cast<std::uint8_t>(crc);
  bytes.insert(bytes.end(), kMagic.begin(), kMagic.end());
  put(bytes);
}

void Writer::put(const Bytes& records) {
  std::size_t written = 0;
  while (written < records.size()) {
    const ::ssize_t count = ::write(file_, records.data() + written, records.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail(count < 0 ? errno : ENOSPC);
    written += static_cast<std::size_t>(count);
  }
  data_crc_ = crc32({records.data(), records.size()}, data_crc_);
  position_ += records.size();
}

void Writer::fail(int error) {
  // Without the begun record a reader sees a file that ends, not a damaged one. A pipe cannot be cut.
  [[maybe_unused]] const int cut = ::ftruncate(file_, static_cast<::off_t>(position_));
  ::close(file_);
  file_ = -1;
  throw std::runtime_error(io::write_fault(path_, error));
}

}  // namespace swiftlet::mcap
