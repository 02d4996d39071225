#include "swiftlet/io/byte_writer.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::io::byte_writer_test {

enum class Kind : std::uint16_t { kThird = 0x0102 };

TEST(ByteWriter, WritesInBothOrders) {
  std::vector<std::uint8_t> bytes;
  append(bytes, std::uint32_t{0x01020304});
  append(bytes, std::uint32_t{0x01020304}, false);
  append(bytes, Kind::kThird);
  append(bytes, 1.0F);  // 0x3f800000
  EXPECT_EQ(bytes, (std::vector<std::uint8_t>{4, 3, 2, 1, 1, 2, 3, 4, 2, 1, 0, 0, 0x80, 0x3f}));
}

TEST(ByteWriter, WritesWhatTheReaderReads) {
  for (const bool little_endian : {true, false}) {
    std::string bytes;
    append(bytes, std::int8_t{-2}, little_endian);
    append(bytes, std::int64_t{-3'000'000'000}, little_endian);
    append(bytes, -0.1, little_endian);
    ByteReader in(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), little_endian);
    EXPECT_EQ(in.number<std::int8_t>(), -2);
    EXPECT_EQ(in.number<std::int64_t>(), -3'000'000'000);
    EXPECT_EQ(in.f64(), -0.1);
    EXPECT_TRUE(in.ok());
    EXPECT_EQ(in.u8(), 0);
    EXPECT_FALSE(in.ok());
  }
}

}  // namespace swiftlet::io::byte_writer_test
