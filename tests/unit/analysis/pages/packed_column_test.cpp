#include "swiftlet/analysis/pages/packed_column.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <zlib.h>

#include <gtest/gtest.h>

namespace swiftlet::pages::packed_column_test {

// What a browser does, by other means.
std::vector<std::uint32_t> unpacked(const std::string& text, std::size_t count) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> compressed;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char digit : text) {
    if (digit == '=') break;
    bits = bits << 6U | static_cast<std::uint32_t>(digits.find(digit));
    held += 6;
    if (held < 8) continue;
    held -= 8;
    compressed.push_back(static_cast<std::uint8_t>(bits >> static_cast<unsigned>(held)));
  }
  EXPECT_EQ(text.size() % 4, 0U);
  std::vector<std::uint8_t> planes(4 * count + 1);
  uLongf size = planes.size();
  EXPECT_EQ(::uncompress(planes.data(), &size, compressed.data(), compressed.size()), Z_OK);
  EXPECT_EQ(size, 4 * count);
  std::vector<std::uint32_t> words(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t byte = 0; byte < 4; ++byte)
      words[i] |= std::uint32_t{planes[byte * count + i]} << 8U * byte;
  }
  return words;
}

TEST(PackedColumn, KeepsNumbersInSinglePrecision) {
  const std::vector<double> numbers = {0.0, -1.5, 1e-30, 0.1, std::numeric_limits<double>::quiet_NaN(), 3e38};
  const std::vector<std::uint32_t> words = unpacked(packed(numbers), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    float number = 0.0F;
    std::memcpy(&number, &words[i], sizeof(number));
    if (std::isnan(numbers[i])) {
      EXPECT_TRUE(std::isnan(number));
    } else {
      EXPECT_EQ(number, static_cast<float>(numbers[i]));
    }
  }
}

TEST(PackedColumn, HasTheStepsOfTimesInMicroseconds) {
  const std::vector<std::uint32_t> steps =
      unpacked(packed_times({-1.0, -0.998, -0.9979991, 4000.0}, -1.002), 4);
  EXPECT_EQ(steps, (std::vector<std::uint32_t>{2000, 2000, 1, 4'000'997'999}));
}

TEST(PackedColumn, ErrorsOfStepsDoNotAddUp) {
  std::vector<double> times_s;
  for (int i = 0; i < 30'000; ++i) times_s.push_back(i / 300.0);
  double time_us = 0.0;
  for (const std::uint32_t step : unpacked(packed_times(times_s, 0.0), times_s.size())) time_us += step;
  EXPECT_NEAR(time_us * 1e-6, times_s.back(), 0.6e-6);
}

TEST(PackedColumn, MayBeEmpty) { EXPECT_TRUE(unpacked(packed({}), 0).empty()); }

}  // namespace swiftlet::pages::packed_column_test
