#include "swiftlet/record/mcap/reader.hpp"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/record/mcap/compression.hpp"
#include "swiftlet/record/mcap/record_writer.hpp"

namespace swiftlet::mcap {
namespace {

[[noreturn]] void fail_to_read(const std::string& path, int error) {
  throw io::ConfigError(path, 0, "", "cannot be read: " + std::generic_category().message(error));
}

ByteView part(ByteView bytes, std::uint64_t offset) {
  return {bytes.data + offset, bytes.size - static_cast<std::size_t>(offset)};
}

bool ends_with_magic(ByteView bytes) {
  return std::equal(kMagic.begin(), kMagic.end(), bytes.data + bytes.size - kMagic.size());
}

// Calls use(record, offset) for each record until it returns false. Returns where it stopped.
template <class Use>
std::uint64_t for_each_record(ByteView bytes, std::uint64_t offset, const Use& use) {
  while (const auto record = first_record(part(bytes, offset))) {
    if (!use(*record, offset)) return offset;
    offset += record->size;
  }
  return offset;
}

}  // namespace

MappedFile::MappedFile(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail_to_read(path, errno);
  struct stat status {};
  const int failed = ::fstat(file, &status);
  if (failed != 0 || !S_ISREG(status.st_mode)) {
    const int error = failed != 0 ? errno : S_ISDIR(status.st_mode) ? EISDIR : ESPIPE;
    ::close(file);
    fail_to_read(path, error);
  }
  bytes_.size = static_cast<std::size_t>(status.st_size);
  void* const data =
      bytes_.size == 0 ? nullptr : ::mmap(nullptr, bytes_.size, PROT_READ, MAP_PRIVATE, file, 0);
  const int error = errno;
  ::close(file);
  if (data == MAP_FAILED) fail_to_read(path, error);
  bytes_.data = static_cast<const std::uint8_t*>(data);
}

MappedFile::~MappedFile() {
  if (bytes_.size > 0) ::munmap(const_cast<std::uint8_t*>(bytes_.data), bytes_.size);
}

Reader::Reader(const std::string& path, Access access)
    : file_(std::make_shared<MappedFile>(path)), bytes_(file_->bytes()), name_(path) {
  read(access);
}

Reader::Reader(ByteView bytes, std::string name, Access access) : bytes_(bytes), name_(std::move(name)) {
  read(access);
}

void Reader::fail(std::uint64_t offset, const std::string& what) const {
  throw io::ConfigError(name_, 0, "", "byte " + std::to_string(offset) + ": " + what);
}

void Reader::damage(std::uint64_t offset, std::string what) { damages_.push_back({offset, std::move(what)}); }

void Reader::read(Access access) {
  if (bytes_.size < kMagic.size() || !std::equal(kMagic.begin(), kMagic.end(), bytes_.data))
    throw io::ConfigError(name_, 0, "", "is not an MCAP file");
  const auto first = first_record(part(bytes_, kMagic.size()));
  const auto header =
      first && first->opcode == Opcode::kHeader ? to_header(first->content) : std::optional<Header>();
  if (!header) fail(kMagic.size(), "there is no header");
  header_ = *header;
  const auto end = footer();
  finished_ = end.has_value();
  if (access == Access::kIndexed && end && end->summary_start != 0 && read_summary(*end)) return;
  schemas_.clear();
  channels_.clear();
  metadata_.clear();
  attachments_.clear();
  chunks_.clear();
  blocks_.clear();
  statistics_ = {};
  scan();
}

std::optional<Footer> Reader::footer() const {
  constexpr std::size_t kEnd = kRecordHeaderBytes + kFooterBytes + kMagic.size();
  if (bytes_.size < 2 * kMagic.size() + kEnd || !ends_with_magic(bytes_)) return std::nullopt;
  const auto record = first_record(part(bytes_, bytes_.size - kEnd));
  if (!record || record->opcode != Opcode::kFooter || record->content.size != kFooterBytes)
    return std::nullopt;
  return to_footer(record->content);
}

void Reader::check_summary(const Footer& footer) const {
  const std::uint64_t crc_at = bytes_.size - kMagic.size() - 4;
  if (footer.summary_start > crc_at) fail(crc_at, "the summary begins behind the end of the file");
  if (footer.summary_crc == 0) return;
  const ByteView summary{bytes_.data + footer.summary_start,
                         static_cast<std::size_t>(crc_at - footer.summary_start)};
  if (crc32(summary) != footer.summary_crc)
    fail(footer.summary_start, "the CRC of the summary is wrong; `swiftlet log repair` reads the rest");
}

// Returns false if the summary does not say where all is: what of it a file repeats there is up to its writer.
bool Reader::read_summary(const Footer& footer) {
  check_summary(footer);
  bool counted = false;
  for_each_record(bytes_, footer.summary_start, [&](const Record& record, std::uint64_t offset) {
    switch (record.opcode) {
      case Opcode::kSchema:
      case Opcode::kChannel:
        add_definition(record);
        return true;
      case Opcode::kStatistics:
        if (const auto statistics = to_statistics(record.content)) {
          statistics_ = *statistics;
          counted = true;
        }
        return true;
      case Opcode::kChunkIndex: {
        const auto index = to_chunk_index(record.content);
        if (!index || index->offset >= bytes_.size || index->length > bytes_.size - index->offset)
          fail(offset, "the index of a chunk lies outside of the file");
        chunks_.push_back(*index);
        blocks_.push_back({index->start_ns, index->end_ns, index->offset, index->length, true});
        return true;
      }
      case Opcode::kMetadataIndex: {
        const auto at = to_metadata_offset(record.content);
        const auto found = at && *at < bytes_.size ? first_record(part(bytes_, *at)) : std::nullopt;
        const auto metadata = found ? to_metadata(found->content) : std::nullopt;
        if (!metadata) fail(offset, "the index of metadata does not lead to any");
        metadata_.push_back(*metadata);
        return true;
      }
      case Opcode::kAttachmentIndex: {
        const auto index = to_attachment_index(record.content);
        if (!index || index->offset >= bytes_.size)
          fail(offset, "the index of an attachment does not lead to one");
        attachments_.push_back(*index);
        return true;
      }
      default:
        return record.opcode != Opcode::kFooter;
    }
  });
  return counted && chunks_.size() == statistics_.chunk_count &&
         schemas_.size() == statistics_.schema_count && channels_.size() == statistics_.channel_count &&
         metadata_.size() == statistics_.metadata_count &&
         attachments_.size() == statistics_.attachment_count &&
         (statistics_.message_count == 0 || !chunks_.empty());
}

void Reader::add_definition(const Record& record) {
  if (record.opcode == Opcode::kSchema) {
    if (auto schema = to_schema(record.content)) schemas_.insert_or_assign(schema->id, std::move(*schema));
  } else if (record.opcode == Opcode::kChannel) {
    if (auto channel = to_channel(record.content))
      channels_.insert_or_assign(channel->id, std::move(*channel));
  }
}

void Reader::count(const Message& message) {
  const std::int64_t time = message.log_time_ns;
  const bool first = statistics_.message_count++ == 0;
  statistics_.start_ns = first ? time : std::min(statistics_.start_ns, time);
  statistics_.end_ns = first ? time : std::max(statistics_.end_ns, time);
  ++statistics_.messages_by_channel[message.channel_id];
}

void Reader::scan() {
  std::uint64_t offset = kMagic.size();
  offset = for_each_record(bytes_, offset,
                           [&](const Record& record, std::uint64_t at) { return scan_record(record, at); });
  if (!finished_ && offset < bytes_.size) damage(offset, "the file ends within a record");
  if (finished_) {
    const auto end = first_record(part(bytes_, offset));
    if (!end || end->opcode != Opcode::kDataEnd) damage(offset, "is not a record");
  }
  statistics_.schema_count = static_cast<std::uint16_t>(schemas_.size());
  statistics_.channel_count = static_cast<std::uint32_t>(channels_.size());
  statistics_.attachment_count = static_cast<std::uint32_t>(attachments_.size());
  statistics_.metadata_count = static_cast<std::uint32_t>(metadata_.size());
  statistics_.chunk_count = static_cast<std::uint32_t>(chunks_.size());
}

// Returns false at the end of the data.
bool Reader::scan_record(const Record& record, std::uint64_t offset) {
  switch (record.opcode) {
    case Opcode::kSchema:
    case Opcode::kChannel:
      add_definition(record);
      return true;
    case Opcode::kChunk:
      scan_chunk(record, offset);
      return true;
    case Opcode::kMessage:
      scan_message(record, offset);
      return true;
    case Opcode::kMetadata:
      if (auto metadata = to_metadata(record.content)) {
        metadata_.push_back(std::move(*metadata));
      } else {
        damage(offset, "the metadata are not readable");
      }
      return true;
    case Opcode::kAttachment: {
      const auto found = to_attachment(record.content);
      if (!found) {
        damage(offset, "the attachment is not readable");
      } else {
        attachments_.push_back({offset, record.size, found->log_time_ns, found->create_time_ns,
                                found->data.size(), found->name, found->media_type});
      }
      return true;
    }
    case Opcode::kDataEnd: {
      const auto crc = to_data_crc(record.content);
      if (crc && *crc != 0 && *crc != crc32({bytes_.data, static_cast<std::size_t>(offset)}))
        damage(offset, "the CRC of the data is wrong");
      return false;
    }
    case Opcode::kFooter:
      return false;
    default:
      return true;
  }
}

void Reader::scan_chunk(const Record& record, std::uint64_t offset) {
  const Block block{0, 0, offset, record.size, true};
  Bytes records;
  if (std::string fault = load(block, records); !fault.empty()) return damage(offset, std::move(fault));
  const auto chunk = to_chunk(record.content);
  ChunkIndex index;
  index.offset = offset;
  index.length = record.size;
  index.compression = chunk->compression;
  index.compressed_size = chunk->records.size;
  index.uncompressed_size = records.size();
  bool first = true;
  bool without_channel = false;
  for_each_record({records.data(), records.size()}, 0, [&](const Record& inner, std::uint64_t) {
    add_definition(inner);
    const auto message = inner.opcode == Opcode::kMessage ? to_message(inner.content) : std::nullopt;
    if (!message) return true;
    if (channels_.count(message->channel_id) == 0) {
      without_channel = true;
      return true;
    }
    count(*message);
    index.start_ns = first ? message->log_time_ns : std::min(index.start_ns, message->log_time_ns);
    index.end_ns = first ? message->log_time_ns : std::max(index.end_ns, message->log_time_ns);
    first = false;
    return true;
  });
  if (without_channel) damage(offset, "the chunk has messages without a channel");
  blocks_.push_back({index.start_ns, index.end_ns, offset, record.size, true});
  chunks_.push_back(std::move(index));
}

void Reader::scan_message(const Record& record, std::uint64_t offset) {
  const auto message = to_message(record.content);
  if (!message) return damage(offset, "the message is not readable");
  if (channels_.count(message->channel_id) == 0) return damage(offset, "the message has no channel");
  count(*message);
  if (blocks_.empty() || blocks_.back().chunk || blocks_.back().offset + blocks_.back().length != offset)
    blocks_.push_back({message->log_time_ns, message->log_time_ns, offset, 0, false});
  Block& block = blocks_.back();
  block.length += record.size;
  block.start_ns = std::min(block.start_ns, message->log_time_ns);
  block.end_ns = std::max(block.end_ns, message->log_time_ns);
}

std::string Reader::load(const Block& block, Bytes& records) const {
  if (!block.chunk) {
    records.assign(bytes_.data + block.offset, bytes_.data + block.offset + block.length);
    return {};
  }
  const auto record = first_record(part(bytes_, block.offset));
  const auto chunk =
      record && record->opcode == Opcode::kChunk ? to_chunk(record->content) : std::optional<Chunk>();
  if (!chunk) return "is not a chunk";
  const auto compression = compression_of(chunk->compression);
  if (!compression) return "the chunk has the compression '" + chunk->compression + "', must be zstd or lz4";
  if (!unpack(*compression, chunk->records, chunk->uncompressed_size, records))
    return "the chunk does not unpack";
  if (chunk->uncompressed_crc != 0 && crc32({records.data(), records.size()}) != chunk->uncompressed_crc)
    return "the CRC of the chunk is wrong";
  return {};
}

const Schema* Reader::schema_of(const Channel& channel) const {
  const auto found = schemas_.find(channel.schema_id);
  return found == schemas_.end() ? nullptr : &found->second;
}

Attachment Reader::attachment(const AttachmentIndex& index) const {
  const auto record = first_record(part(bytes_, index.offset));
  auto found = record && record->opcode == Opcode::kAttachment ? to_attachment(record->content)
                                                               : std::optional<Attachment>();
  if (!found) fail(index.offset, "is not an attachment");
  const ByteView content = record->content;
  const std::uint8_t* const stored = content.data + content.size - 4;
  const std::uint32_t crc = io::ByteReader(stored, 4, true).u32();
  if (crc != 0 && crc != crc32({content.data, content.size - 4}))
    fail(index.offset, "the CRC of the attachment is wrong");
  return std::move(*found);
}

// A block in memory, with its selected messages in order.
struct Messages::Loaded {
  std::size_t block = 0;
  Bytes records;
  std::vector<Message> messages;
  std::size_t next = 0;

  std::int64_t time_ns() const { return messages[next].log_time_ns; }
  // For a heap whose front is the earliest.
  static bool is_later(const std::unique_ptr<Loaded>& a, const std::unique_ptr<Loaded>& b) {
    return a->time_ns() != b->time_ns() ? a->time_ns() > b->time_ns() : a->block > b->block;
  }
};

Messages::Messages(const Reader& reader, Selection selection)
    : reader_(reader), selection_(std::move(selection)) {
  for (const auto& [id, channel] : reader.channels()) {
    if (selection_.topics.empty() || selection_.topics.count(channel.topic) != 0) channels_.insert(id);
  }
  for (std::size_t i = 0; i < reader.blocks_.size(); ++i) {
    const Reader::Block& block = reader.blocks_[i];
    if (block.end_ns >= selection_.from_ns && block.start_ns < selection_.to_ns) order_.push_back(i);
  }
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return reader.blocks_[a].start_ns < reader.blocks_[b].start_ns;
  });
}

Messages::~Messages() = default;
Messages::Messages(Messages&&) noexcept = default;

void Messages::load(std::size_t block) {
  auto loaded = std::make_unique<Loaded>();
  loaded->block = block;
  const Reader::Block& place = reader_.blocks_[block];
  if (const std::string fault = reader_.load(place, loaded->records); !fault.empty())
    reader_.fail(place.offset, fault + "; `swiftlet log repair` keeps the rest");
  for_each_record(
      {loaded->records.data(), loaded->records.size()}, 0, [&](const Record& record, std::uint64_t) {
        const auto message = record.opcode == Opcode::kMessage ? to_message(record.content) : std::nullopt;
        if (message && channels_.count(message->channel_id) != 0 &&
            message->log_time_ns >= selection_.from_ns && message->log_time_ns < selection_.to_ns)
          loaded->messages.push_back(*message);
        return true;
      });
  if (loaded->messages.empty()) return;
  std::stable_sort(loaded->messages.begin(), loaded->messages.end(),
                   [](const Message& a, const Message& b) { return a.log_time_ns < b.log_time_ns; });
  loaded_.push_back(std::move(loaded));
  std::push_heap(loaded_.begin(), loaded_.end(), Loaded::is_later);
}

bool Messages::next() {
  spent_.reset();
  while (next_block_ < order_.size()) {
    const std::size_t block = order_[next_block_];
    if (!loaded_.empty() && loaded_.front()->time_ns() < reader_.blocks_[block].start_ns) break;
    ++next_block_;
    load(block);
  }
  if (loaded_.empty()) return false;
  std::pop_heap(loaded_.begin(), loaded_.end(), Loaded::is_later);
  Loaded& earliest = *loaded_.back();
  message_ = earliest.messages[earliest.next++];
  if (earliest.next < earliest.messages.size()) {
    std::push_heap(loaded_.begin(), loaded_.end(), Loaded::is_later);
  } else {
    spent_ = std::move(loaded_.back());
    loaded_.pop_back();
  }
  return true;
}

const Message& Messages::message() const { return message_; }
const Channel& Messages::channel() const { return reader_.channels().at(message_.channel_id); }

}  // namespace swiftlet::mcap
