// Reads a message in CDR, as its members follow each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/record/mcap/records.hpp"

namespace swiftlet::mcap {

// Like io::ByteReader, a read beyond the end returns zeros and makes ok() false for good. So does another encoding than plain
// CDR.
class CdrReader {
 public:
  explicit CdrReader(ByteView payload)
      : in_(payload.data, payload.size, payload.size > 1 && payload.data[1] == 1) {
    const bool is_cdr = payload.size >= kHeaderBytes && payload.data[0] == 0 && payload.data[1] <= 1;
    in_.skip(is_cdr ? kHeaderBytes : payload.size + 1);
    begin_ = in_.rest();
  }

  template <class Number>
  Number number() {
    in_.skip((sizeof(Number) - (begin_ - in_.rest()) % sizeof(Number)) % sizeof(Number));
    return in_.number<Number>();
  }
  std::string_view text() {
    const auto length = number<std::uint32_t>();  // with its NUL
    const std::uint8_t* const text = in_.take(length);
    if (text == nullptr || length == 0) return {};
    return {reinterpret_cast<const char*>(text), length - 1};
  }
  bool ok() const { return in_.ok(); }

 private:
  static constexpr std::size_t kHeaderBytes = 4;

  io::ByteReader in_;
  std::size_t begin_ = 0;  // what was left behind the header: members are aligned from there
};

}  // namespace swiftlet::mcap
