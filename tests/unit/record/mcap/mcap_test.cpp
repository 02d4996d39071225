#include <csignal>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <sys/resource.h>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/record/mcap/merge.hpp"
#include "swiftlet/record/mcap/reader.hpp"
#include "swiftlet/record/mcap/record_writer.hpp"
#include "swiftlet/record/mcap/topic_decoder.hpp"
#include "swiftlet/record/mcap/writer.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/io/config_error_check.hpp"
#include "tests/unit/record/mcap/recorded_file.hpp"

namespace swiftlet::mcap::mcap_test {

using tests::file_content;
using tests::KeptMessage;
using tests::messages_of;
using tests::nth_message;
using tests::refusal;
using tests::view_of;
using tests::write_file;

constexpr int kCount = 30;

std::vector<KeptMessage> first_messages(int count) {
  std::vector<KeptMessage> messages;
  for (int i = 0; i < count; ++i) messages.push_back(nth_message(i));
  return messages;
}

class McapTest : public testing::Test {
 protected:
  std::string path(const std::string& name = "flight.mcap") const { return folder_.path() / name; }
  tests::TemporaryFolder folder_;
};

class McapWith : public McapTest, public testing::WithParamInterface<Compression> {};
INSTANTIATE_TEST_SUITE_P(Compression, McapWith,
                         testing::Values(Compression::kNone, Compression::kZstd, Compression::kLz4));

TEST_P(McapWith, WhatIsWrittenIsRead) {
  write_file(path(), kCount, GetParam());
  for (const Access access : {Access::kIndexed, Access::kScanned}) {
    const Reader file(path(), access);
    EXPECT_TRUE(file.finished());
    EXPECT_TRUE(file.damages().empty());
    EXPECT_EQ(file.header().profile, "ros2");
    EXPECT_EQ(file.header().library, "test");
    EXPECT_EQ(messages_of(file), first_messages(kCount));
    ASSERT_EQ(file.metadata().size(), 1U);
    EXPECT_EQ(file.metadata().front().values.at("mission"), "square");
    ASSERT_EQ(file.attachments().size(), 1U);
    EXPECT_EQ(file.attachment(file.attachments().front()).data, "name: kl1\n");
    const Channel& imu = file.channels().at(0);
    EXPECT_EQ(imu.metadata.at("kind"), "stream");
    EXPECT_EQ(file.schema_of(imu)->data, "float64 x");
    const Statistics& statistics = file.statistics();
    EXPECT_EQ(statistics.message_count, 30U);
    EXPECT_EQ(statistics.messages_by_channel, (std::map<std::uint16_t, std::uint64_t>{{0, 15}, {1, 15}}));
    EXPECT_EQ(statistics.start_ns, 1000);
    EXPECT_EQ(statistics.end_ns, 30000);
    EXPECT_EQ(statistics.chunk_count, file.chunks().size());
    EXPECT_GE(file.chunks().size(), 5U);
    EXPECT_EQ(file.chunks().front().compression, to_string(GetParam()));
  }
}

// The file of a killed writer, cut after any number of bytes.
TEST_P(McapWith, ACutFileIsReadUpToItsLastWholeChunk) {
  write_file(path(), kCount, GetParam());
  const std::string whole = file_content(path());
  const Reader reader(path());
  const std::size_t first = reader.chunks().front().offset;
  std::size_t read_before = 0;
  for (std::size_t size = first; size < whole.size(); ++size) {
    const std::string cut = whole.substr(0, size);
    const Reader file(view_of(cut), "cut");
    EXPECT_FALSE(file.finished());
    std::size_t chunks = 0;
    for (const ChunkIndex& chunk : reader.chunks()) chunks += chunk.offset + chunk.length <= size ? 1 : 0;
    EXPECT_EQ(file.chunks().size(), chunks);
    const auto messages = messages_of(file);
    EXPECT_EQ(messages, first_messages(static_cast<int>(messages.size())));
    EXPECT_EQ(messages.size(), file.statistics().message_count);
    EXPECT_GE(messages.size(), read_before);
    read_before = messages.size();
  }
  EXPECT_EQ(read_before, static_cast<std::size_t>(kCount));
}

// CRCs cover every byte of the data and of the summary.
TEST_P(McapWith, ASpoiledByteIsNeverRead) {
  write_file(path(), kCount, GetParam());
  const std::string whole = file_content(path());
  const ChunkIndex last = Reader(path()).chunks().back();
  const std::size_t data_end = last.offset + last.length + last.message_index_length;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string spoiled = whole;
    spoiled[i] = static_cast<char>(spoiled[i] ^ 0x41);
    for (const Access access : {Access::kIndexed, Access::kScanned}) {
      bool known = false;  // that it is spoiled
      std::vector<KeptMessage> messages;
      try {
        const Reader file(view_of(spoiled), "spoiled", access);
        known = !file.finished() || !file.damages().empty();
        messages = messages_of(file);
      } catch (const io::ConfigError&) {
        known = true;
      }
      EXPECT_TRUE(known || messages == first_messages(kCount)) << "byte " << i;
      EXPECT_TRUE(known || access == Access::kIndexed || i >= data_end) << "byte " << i;
    }
  }
}

TEST_F(McapTest, ADamagedChunkLosesNoOther) {
  write_file(path(), kCount, Compression::kZstd);
  std::string spoiled = file_content(path());
  const Reader whole(path());
  const ChunkIndex& second = whole.chunks().at(1);
  spoiled[second.offset + second.length - 3] ^= 0x10;
  EXPECT_EQ(refusal([&] { messages_of(Reader(view_of(spoiled), "spoiled.mcap")); }),
            "spoiled.mcap: byte " + std::to_string(second.offset) +
                ": the CRC of the chunk is wrong; `swiftlet log repair` keeps the rest");

  const Reader file(view_of(spoiled), "spoiled.mcap", Access::kScanned);
  ASSERT_EQ(file.damages().size(), 2U);
  EXPECT_EQ(file.damages().front().offset, second.offset);
  EXPECT_EQ(file.damages().back().what, "the CRC of the data is wrong");
  std::vector<KeptMessage> expected;
  for (const KeptMessage& message : first_messages(kCount)) {
    if (message.log_time_ns < second.start_ns || message.log_time_ns > second.end_ns)
      expected.push_back(message);
  }
  EXPECT_EQ(messages_of(file), expected);
}

TEST_F(McapTest, MessagesComeInOrderOfTimeAlsoIfChunksOverlap) {
  {
    Writer file(path(), tests::small_chunks(Compression::kZstd));
    tests::begin_file(file);
    for (int i = 0; i < kCount; ++i) tests::write_message(file, (i * 7) % kCount);
    file.close();
  }
  EXPECT_EQ(messages_of(Reader(path())), first_messages(kCount));
}

TEST_F(McapTest, TopicsAndTimesAreSelected) {
  write_file(path(), kCount);
  Selection selection;
  selection.topics = {"/kl1/battery"};
  selection.from_ns = nth_message(5).log_time_ns;
  selection.to_ns = nth_message(11).log_time_ns;
  EXPECT_EQ(messages_of(Reader(path()), selection),
            (std::vector<KeptMessage>{nth_message(5), nth_message(7), nth_message(9)}));
}

TEST_F(McapTest, FilesAreMergedInOrderOfTime) {
  for (int part = 0; part < 3; ++part) {
    Writer file(path(std::to_string(part)), tests::small_chunks(Compression::kLz4));
    tests::begin_file(file);
    for (int i = part; i < kCount; i += 3) tests::write_message(file, i);
    file.close();
  }
  const Reader a(path("0"));
  const Reader b(path("1"));
  const Reader c(path("2"));
  Writer out(path(), {});
  merge({&a, &b, &c}, {}, out);
  out.close();
  const Reader merged(path());
  EXPECT_EQ(messages_of(merged), first_messages(kCount));
  EXPECT_EQ(merged.channels().size(), 2U);
  EXPECT_EQ(merged.schemas().size(), 2U);
  EXPECT_EQ(merged.metadata().size(), 3U);
  EXPECT_EQ(merged.attachments().size(), 3U);
}

// The limit of a file's size stands for a full disk.
// The file without the records of some kinds in its summary, and without the CRC of that.
std::string with_less_summary(const std::string& whole, const std::set<Opcode>& left_out) {
  constexpr std::size_t kFooterAndMagic = 9 + 20 + 8;
  const std::size_t footer_at = whole.size() - kFooterAndMagic;
  const auto footer = to_footer(first_record(view_of(whole.substr(footer_at)))->content);
  std::string file = whole.substr(0, footer->summary_start);
  for (std::size_t at = footer->summary_start; at < footer_at;) {
    const std::string rest = whole.substr(at, footer_at - at);
    const auto record = first_record(view_of(rest));
    if (left_out.count(record->opcode) == 0) file += rest.substr(0, record->size);
    at += record->size;
  }
  const bool is_empty = file.size() == footer->summary_start;
  Bytes end;
  RecordWriter out(end);
  out.begin(Opcode::kFooter);
  out.u64(is_empty ? 0 : footer->summary_start).u64(0).u32(0);
  out.end();
  return file + std::string(end.begin(), end.end()) + whole.substr(whole.size() - 8);
}

// MCAP leaves to the writer what a summary repeats and indexes. All choices of six kinds of records.
TEST_F(McapTest, AFileIsReadWhateverItsSummaryLeavesOut) {
  write_file(path(), kCount);
  const std::string whole = file_content(path());
  constexpr Opcode kKinds[] = {Opcode::kSchema,     Opcode::kChannel,         Opcode::kStatistics,
                               Opcode::kChunkIndex, Opcode::kAttachmentIndex, Opcode::kMetadataIndex};
  for (unsigned choice = 0; choice < 64; ++choice) {
    std::set<Opcode> left_out{Opcode::kSummaryOffset};
    for (unsigned kind = 0; kind < 6; ++kind) {
      if ((choice >> kind & 1U) != 0) left_out.insert(kKinds[kind]);
    }
    const std::string less = with_less_summary(whole, left_out);
    const Reader file(view_of(less), "less");
    EXPECT_TRUE(file.damages().empty()) << choice;
    EXPECT_EQ(messages_of(file), first_messages(kCount)) << choice;
    for (const auto& [id, channel] : file.channels())
      ASSERT_NE(file.schema_of(channel), nullptr) << channel.topic << ", " << choice;
    EXPECT_EQ(file.schemas().size(), 2U) << choice;
    EXPECT_EQ(file.metadata().size(), 1U) << choice;
    ASSERT_EQ(file.attachments().size(), 1U) << choice;
    EXPECT_EQ(file.statistics().message_count, 30U) << choice;
  }
}

TEST_F(McapTest, AFullDiskLeavesAReadableFile) {
  ::signal(SIGXFSZ, SIG_IGN);
  ::rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const ::rlimit limit{2000, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  int written = 0;
  std::string fault;
  {
    Writer file(path(), tests::small_chunks(Compression::kNone));
    tests::begin_file(file);
    try {
      for (; written < 1000; ++written) tests::write_message(file, written);
    } catch (const std::runtime_error& error) {
      fault = error.what();
    }
    tests::write_message(file, written);
    file.close();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(fault, path() + ": cannot be written: File too large");
  const Reader file(path());
  EXPECT_FALSE(file.finished());
  EXPECT_TRUE(file.damages().empty());
  const auto messages = messages_of(file);
  EXPECT_GE(messages.size(), 8U);
  EXPECT_EQ(messages, first_messages(static_cast<int>(messages.size())));
}

TEST_F(McapTest, WhatIsNoMcapFileIsRefused) {
  EXPECT_EQ(refusal([&] { Reader(path("missing")); }),
            path("missing") + ": cannot be read: No such file or directory");
  EXPECT_EQ(refusal([&] { Reader(folder_.path().string()); }),
            folder_.path().string() + ": cannot be read: Is a directory");
  EXPECT_EQ(refusal([&] { Reader(folder_.write("empty", "")); }), path("empty") + ": is not an MCAP file");
  EXPECT_EQ(refusal([&] { Reader(folder_.write("text", "t,x,y,z\n1,2,3,4\n")); }),
            path("text") + ": is not an MCAP file");
  EXPECT_EQ(refusal([&] {
              Reader(folder_.write("magic", {kMagic.begin(), kMagic.end()}));
            }),
            path("magic") + ": byte 8: there is no header");
}

// Two recorders may have given a topic a channel each, but columns of one type are not read as those of another.
TEST_F(McapTest, ATopicOfTwoTypesIsRefused) {
  const auto fault_of = [&](const std::string& second) -> std::string {
    const std::string path = folder_.path() / (second.substr(0, 6) + ".mcap");
    Writer file(path, {});
    for (const std::string& definition : {std::string("float64 x\nstring name"), second}) {
      const std::uint16_t schema = file.add_schema("test_msgs/msg/A", "ros2msg", definition);
      file.add_channel("/kl1/a", schema, "cdr", {});
    }
    file.close();
    try {
      TopicDecoder(Reader(path), "/kl1/a");
    } catch (const io::ConfigError& fault) {
      return fault.what();
    }
    return "";
  };
  EXPECT_EQ(fault_of("float64 x\nstring name"), "");
  EXPECT_NE(fault_of("string x\nfloat64 name").find("/kl1/a: was recorded with types that differ"),
            std::string::npos);
}

TEST_F(McapTest, FlushingNothingChangesNothing) {
  {
    Writer file(path(), tests::small_chunks(Compression::kZstd));
    file.flush();
    tests::begin_file(file);
    for (int i = 0; i < kCount; ++i) {
      tests::write_message(file, i);
      file.flush();
      file.flush();
    }
    file.flush();
    file.close();
  }
  const Reader file(path(), Access::kScanned);
  EXPECT_TRUE(file.damages().empty());
  EXPECT_EQ(messages_of(file), first_messages(kCount));
  EXPECT_EQ(file.chunks().size(), static_cast<std::size_t>(kCount));
}

TEST_F(McapTest, AFileWithoutMessagesIsWhole) {
  Writer(path(), {}).close();
  const Reader file(path());
  EXPECT_TRUE(file.finished());
  EXPECT_TRUE(messages_of(file).empty());
}

}  // namespace swiftlet::mcap::mcap_test
