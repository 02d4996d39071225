// Reads an MCAP file (records.hpp), also one whose writer was killed.
//
//   Reader file("flight.mcap");
//   Messages messages(file, {});
//   while (messages.next()) use(messages.channel(), messages.message());
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "swiftlet/record/mcap/record_reader.hpp"
#include "swiftlet/record/mcap/records.hpp"

namespace swiftlet::mcap {

// A file in memory, as the system reads it in.
class MappedFile {
 public:
  explicit MappedFile(const std::string& path);  // throws ConfigError
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ByteView bytes() const { return bytes_; }

 private:
  ByteView bytes_;
};

enum class Access {
  kIndexed,  // by the summary, if there is one
  kScanned,  // every record; reports damages
};

// Unreadable bytes of the file.
struct Damage {
  std::uint64_t offset = 0;
  std::string what;  // a clause: "the chunk does not unpack"
};

class Reader {
 public:
  // A file without a summary is scanned. Throws ConfigError if it cannot be read or is not an MCAP file, and with
  // kIndexed also if the summary is damaged.
  explicit Reader(const std::string& path, Access access = Access::kIndexed);
  // bytes must outlive the reader. name: of the file, for errors
  Reader(ByteView bytes, std::string name, Access access = Access::kIndexed);

  const std::string& name() const { return name_; }
  std::uint64_t file_bytes() const { return bytes_.size; }
  const Header& header() const { return header_; }
  // False if the writer did not finish the file: the messages are those up to its end.
  bool finished() const { return finished_; }
  const std::vector<Damage>& damages() const { return damages_; }

  const std::map<std::uint16_t, Schema>& schemas() const { return schemas_; }
  const std::map<std::uint16_t, Channel>& channels() const { return channels_; }
  const Schema* schema_of(const Channel& channel) const;  // null: none
  const std::vector<Metadata>& metadata() const { return metadata_; }
  const std::vector<AttachmentIndex>& attachments() const { return attachments_; }
  // Throws ConfigError if it is damaged.
  Attachment attachment(const AttachmentIndex& index) const;
  const std::vector<ChunkIndex>& chunks() const { return chunks_; }
  // As the file has it, else counted.
  const Statistics& statistics() const { return statistics_; }

 private:
  friend class Messages;
  // Messages that are read in one piece: a chunk, or records outside of chunks.
  struct Block {
    std::int64_t start_ns = 0;
    std::int64_t end_ns = 0;
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
    bool chunk = true;
  };

  void read(Access access);
  std::optional<Footer> footer() const;
  bool read_summary(const Footer& footer);
  void check_summary(const Footer& footer) const;
  void scan();
  bool scan_record(const Record& record, std::uint64_t offset);
  void scan_chunk(const Record& record, std::uint64_t offset);
  void scan_message(const Record& record, std::uint64_t offset);
  void add_definition(const Record& record);
  void count(const Message& message);
  void damage(std::uint64_t offset, std::string what);
  // The records of a block; "" or what is wrong with it.
  std::string load(const Block& block, Bytes& records) const;
  [[noreturn]] void fail(std::uint64_t offset, const std::string& what) const;

  std::shared_ptr<const MappedFile> file_;
  ByteView bytes_;
  std::string name_;
  Header header_;
  bool finished_ = false;
  std::vector<Damage> damages_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<Metadata> metadata_;
  std::vector<AttachmentIndex> attachments_;
  std::vector<ChunkIndex> chunks_;
  std::vector<Block> blocks_;
  Statistics statistics_;
};

struct Selection {
  std::set<std::string> topics{};  // empty: all
  std::int64_t from_ns = std::numeric_limits<std::int64_t>::min();
  std::int64_t to_ns = std::numeric_limits<std::int64_t>::max();  // messages before it
};

// The messages of a file in the order of their log times; those of equal time in the order of the file. Holds only
// chunks in memory whose times overlap. The reader must outlive it.
class Messages {
 public:
  Messages(const Reader& reader, Selection selection);
  ~Messages();
  Messages(Messages&&) noexcept;
  Messages& operator=(Messages&&) = delete;

  // Goes to the next message. False if there is none. Leaves out the damages of a reader that has scanned the file;
  // else throws ConfigError for a damaged chunk.
  bool next();
  // Valid until next().
  const Message& message() const;
  const Channel& channel() const;

 private:
  struct Loaded;
  void load(std::size_t block);

  const Reader& reader_;
  Selection selection_;
  std::set<std::uint16_t> channels_;
  std::vector<std::size_t> order_;  // of the blocks, by start
  std::size_t next_block_ = 0;
  std::vector<std::unique_ptr<Loaded>> loaded_;  // a heap by the time of the next message
  std::unique_ptr<Loaded> spent_;                // holds the current message, if that is its last
  Message message_;
};

}  // namespace swiftlet::mcap
