// Writes a message as CDR, little-endian, with the encapsulation header.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "swiftlet/io/byte_writer.hpp"
#include "swiftlet/record/mcap/records.hpp"

namespace swiftlet::record {

class CdrWriter {
 public:
  template <class Number>
  CdrWriter& put(Number number) {
    while ((bytes_.size() - kHeaderBytes) % sizeof(number) != 0) bytes_.push_back(0);
    io::append(bytes_, number);
    return *this;
  }
  CdrWriter& text(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.push_back(0);
    return *this;
  }
  mcap::Bytes take() { return std::move(bytes_); }

 private:
  static constexpr std::size_t kHeaderBytes = 4;
  mcap::Bytes bytes_ = {0, 1, 0, 0};
};

}  // namespace swiftlet::record
