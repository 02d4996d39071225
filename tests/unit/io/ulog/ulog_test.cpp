#include "swiftlet/io/ulog/ulog.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "tests/support/ulog_writer.hpp"

namespace swiftlet::ulog::ulog_test {

using tests::UlogWriter;

UlogWriter written() {
  UlogWriter file;
  file.format("inner:int16_t a;uint8_t[2] b;");
  file.format("motion:uint64_t timestamp;float[3] xyz;inner[2] parts;bool valid;char[4] text;");
  file.parameter("MPC_THR_HOVER", 0.375F);
  file.subscribe(7, "motion");
  file.subscribe(8, "motion", 1);
  for (std::uint64_t i = 0; i < 3; ++i) {
    std::string fields;
    for (const float value : {1.0F, 2.0F, 3.5F}) fields += UlogWriter::raw(value);
    for (const int part : {-5, 6}) {
      fields += UlogWriter::raw(static_cast<std::int16_t>(part));
      fields += UlogWriter::raw(std::uint8_t{200}) + UlogWriter::raw(static_cast<std::uint8_t>(i));
    }
    file.data(7, 1'000'000 + 10'000 * i, fields + UlogWriter::raw(std::uint8_t{1}) + "text");
  }
  return file;
}

TEST(Ulog, ReadsFieldsOfArraysAndNestedFormats) {
  const UlogWriter file = written();
  const Log log(file.bytes(), "a.ulg");
  EXPECT_TRUE(log.has("motion"));
  EXPECT_FALSE(log.has("battery_status"));
  const Table table = log.read("motion", {"xyz[2]", "parts[1].a", "parts[1].b[1]", "valid"});
  ASSERT_EQ(table.rows(), 3U);
  EXPECT_DOUBLE_EQ(table.time_s[2], 1.02);
  EXPECT_EQ(table.columns[0][0], 3.5);
  EXPECT_EQ(table.columns[1][1], 6.0);
  EXPECT_EQ(table.columns[2][2], 2.0);
  EXPECT_EQ(table.columns[3][0], 1.0);
  EXPECT_EQ(log.parameter("MPC_THR_HOVER"), 0.375);
  EXPECT_FALSE(log.ends_early());
}

TEST(Ulog, IsReadUpToItsEnd) {
  const UlogWriter file = written();
  const std::string cut = file.bytes().substr(0, file.bytes().size() - 5);
  const Log log(cut, "a.ulg");
  EXPECT_TRUE(log.ends_early());
  EXPECT_EQ(log.read("motion", {"valid"}).rows(), 2U);
}

// The flags stand first, after the header: 8 bytes to ignore, 8 not to ignore, three offsets of appended data.
std::string with_appended_at(std::string bytes, std::uint64_t offset) {
  constexpr std::size_t kFlags = 16 + 3;
  bytes[kFlags + 8] = 1;
  bytes.replace(kFlags + 16, 8, UlogWriter::raw(offset));
  return bytes;
}

// After a crash PX4 appends its dump to a log whose last message was cut off.
TEST(Ulog, AppendedDataIsReadBehindAMessageThatWasCutOff) {
  const UlogWriter whole = written();
  const std::string cut = whole.bytes().substr(0, whole.bytes().size() - 5);
  UlogWriter more;
  const std::size_t begin = more.bytes().size();
  more.message('I', "dump");
  std::string fields(37, '\1');
  more.data(7, 5'000'000, fields);
  const std::string bytes = with_appended_at(cut + more.bytes().substr(begin), cut.size());
  const Log log(bytes, "a.ulg");
  EXPECT_TRUE(log.ends_early()) << "the part before";
  const Table table = log.read("motion", {"valid"});
  ASSERT_EQ(table.rows(), 3U);
  EXPECT_DOUBLE_EQ(table.time_s[1], 1.01);
  EXPECT_DOUBLE_EQ(table.time_s[2], 5.0);
  EXPECT_FALSE(
      Log(with_appended_at(whole.bytes() + more.bytes().substr(begin), whole.bytes().size()), "a.ulg")
          .ends_early());
  EXPECT_TRUE(Log(with_appended_at(cut, cut.size() + 100), "a.ulg").ends_early()) << "it was lost itself";
  EXPECT_THROW(Log(with_appended_at(bytes, 20), "a.ulg"), io::ConfigError) << "within the flags";
}

// 100 messages of two topics, 10 ms apart, with 5,000 bytes of zeros in place of some, and with the same bytes left out or of noise.
TEST(Ulog, IsReadBehindWhatIsLostWithin) {
  UlogWriter file;
  file.format("motion:uint64_t timestamp;float[12] xyz;uint8_t kind;uint8_t[7] _padding0;");
  file.format("state:uint64_t timestamp;uint8_t[16] values;");
  file.subscribe(7, "motion");
  file.subscribe(8, "state");
  std::vector<std::size_t> begins;
  for (std::uint64_t i = 0; i < 200; ++i) {
    begins.push_back(file.bytes().size());
    std::string fields;
    for (int k = 0; k < 12; ++k) fields += UlogWriter::raw(static_cast<float>(i + 1));
    file.data(7, 1'000'000 + 10'000 * i, fields + "k");
    file.data(8, 1'000'000 + 10'000 * i, std::string(16, 'x'));
  }
  const std::size_t at = begins[50] + 20;  // within a message
  std::string zeros = file.bytes();
  zeros.replace(at, 5000, std::string(5000, '\0'));
  std::string hole = file.bytes();
  hole.erase(at, 5000);
  std::string noise = file.bytes();
  for (std::size_t i = 0; i < 5000; ++i) noise[at + i] = static_cast<char>(i * i * 2654435761U >> 13U);
  for (const std::string& bytes : {zeros, hole, noise}) {
    const Log log(bytes, "a.ulg");
    EXPECT_FALSE(log.ends_early());
    const Table table = log.read("motion", {"xyz[0]"});
    for (std::size_t i = 0; i < table.rows(); ++i)
      EXPECT_NEAR(table.columns[0][i], 100.0 * (table.time_s[i] - 1.0) + 1.0, 1e-6) << "no value is made up";
    ASSERT_EQ(log.losses().size(), 1U);
    const Loss loss = log.losses().front();
    EXPECT_NEAR(loss.from_s, 1.49, 1e-9);
    EXPECT_NEAR(loss.until_s, 2.05, 0.011) << "55 rows are 5,005 bytes";
    EXPECT_NEAR(static_cast<double>(table.rows()) + 100.0 * (loss.until_s - loss.from_s), 200.5, 0.6);
  }
  EXPECT_NEAR(static_cast<double>(Log(zeros, "a.ulg").losses().front().bytes), 5000.0, 100.0);
}

TEST(Ulog, TellsWhenPx4CouldNotLog) {
  UlogWriter file = written();
  file.message('O', UlogWriter::raw(std::uint16_t{35}));
  const Log log(file.bytes(), "a.ulg");
  ASSERT_EQ(log.losses().size(), 1U);
  EXPECT_EQ(log.losses().front().bytes, 0U);
  EXPECT_DOUBLE_EQ(log.losses().front().from_s, 1.02);
  EXPECT_DOUBLE_EQ(log.losses().front().until_s, 1.055);
}

TEST(Ulog, PaddingHasItsPlaceAndIsNotLoggedAtTheEnd) {
  UlogWriter file;
  file.format("inner:uint8_t a;uint8_t[3] _padding0;");
  file.format("padded:uint64_t timestamp;inner[2] parts;;float x;uint8_t[4] _padding0;");
  file.subscribe(3, "padded");
  file.data(3, 1'000'000, std::string("\5\0\0\0\6\0\0\0", 8) + UlogWriter::raw(2.5F));
  const Table table = Log(file.bytes(), "a.ulg").read("padded", {"parts[1].a", "x"});
  ASSERT_EQ(table.rows(), 1U);
  EXPECT_EQ(table.columns[0][0], 6.0);
  EXPECT_EQ(table.columns[1][0], 2.5);
}

std::string fault_of(const std::string& bytes, const std::string& topic, const std::string& field) {
  try {
    Log(bytes, "a.ulg").read(topic, {field});
  } catch (const io::ConfigError& fault) {
    return fault.what();
  }
  return "";
}

TEST(Ulog, NamesWhatIsMissing) {
  UlogWriter file = written();
  EXPECT_EQ(fault_of("ULog?", "motion", "valid"), "a.ulg: is no ULog of PX4");
  EXPECT_EQ(fault_of(file.bytes(), "attitude", "q"), "a.ulg: has no messages of topic attitude");
  EXPECT_EQ(fault_of(file.bytes(), "motion", "w"), "a.ulg: topic motion has no number w");
  EXPECT_EQ(fault_of(file.bytes(), "motion", "text[0]"), "a.ulg: topic motion has no number text[0]");
  EXPECT_THROW(Log(file.bytes(), "a.ulg").parameter("NONE"), io::ConfigError);
  file.format("loop:uint64_t timestamp;loop inside;");
  file.subscribe(9, "loop");
  file.data(9, 1, "");
  EXPECT_EQ(fault_of(file.bytes(), "loop", "x"), "a.ulg: has no format of loop");
  file.format("short:uint64_t timestamp;float x;");
  file.subscribe(11, "short");
  file.data(11, 1, "ab");
  EXPECT_EQ(fault_of(file.bytes(), "short", "x"),
            "a.ulg: has no message of topic short that is as long as its format");
  for (const std::string field : {"float", "float[] x", "float[0] x", "float[2 x", "float[70000] x", " x"}) {
    UlogWriter odd = written();
    odd.format("odd:uint64_t timestamp;" + field + ";");
    EXPECT_EQ(fault_of(odd.bytes(), "motion", "valid"),
              "a.ulg: has a format that is not understood: odd, field '" + field + "'");
  }
  std::string flags(40, '\0');
  flags[9] = 1;
  file.message('B', flags);
  EXPECT_EQ(fault_of(file.bytes(), "motion", "valid"),
            "a.ulg: uses features of ULog that are not known here");
}

}  // namespace swiftlet::ulog::ulog_test
