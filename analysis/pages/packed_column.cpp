#include "swiftlet/analysis/pages/packed_column.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <zlib.h>

namespace swiftlet::pages {
namespace {

constexpr int kCompressionLevel = 2;
constexpr double kMicrosecondsPerS = 1e6;

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return i + k < bytes.size() ? std::uint32_t{bytes[i + k]} : 0U; };
    const std::uint32_t group = byte(0) << 16U | byte(1) << 8U | byte(2);
    text += kDigits[group >> 18U];
    text += kDigits[group >> 12U & 63U];
    text += i + 1 < bytes.size() ? kDigits[group >> 6U & 63U] : '=';
    text += i + 2 < bytes.size() ? kDigits[group & 63U] : '=';
  }
  return text;
}

std::string packed_words(const std::vector<std::uint32_t>& words) {
  std::vector<std::uint8_t> planes(4 * words.size());
  for (std::size_t i = 0; i < words.size(); ++i) {
    for (std::size_t byte = 0; byte < 4; ++byte)
      planes[byte * words.size() + i] = static_cast<std::uint8_t>(words[i] >> 8U * byte);
  }
  uLongf size = ::compressBound(planes.size());
  std::vector<std::uint8_t> compressed(size);
  if (::compress2(compressed.data(), &size, planes.data(), planes.size(), kCompressionLevel) != Z_OK)
    throw std::runtime_error("a column could not be compressed: out of memory");
  compressed.resize(size);
  return base64(compressed);
}

}  // namespace

std::string packed(const std::vector<double>& numbers) {
  std::vector<std::uint32_t> words(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = static_cast<float>(numbers[i]);
    std::memcpy(&words[i], &number, sizeof(number));
  }
  return packed_words(words);
}

std::string packed_times(const std::vector<double>& times_s, double start_s) {
  std::vector<std::uint32_t> steps(times_s.size());
  std::int64_t last_us = 0;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const std::int64_t time_us = std::llround((times_s[i] - start_s) * kMicrosecondsPerS);
    steps[i] = static_cast<std::uint32_t>(time_us - last_us);
    last_us = time_us;
  }
  return packed_words(steps);
}

}  // namespace swiftlet::pages
