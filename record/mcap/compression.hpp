// Compression of the chunks of an MCAP file.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>

#include "swiftlet/record/mcap/records.hpp"

namespace swiftlet::mcap {

enum class Compression { kNone, kZstd, kLz4 };

// As in a file: "", "zstd", "lz4".
const char* to_string(Compression compression);
std::optional<Compression> compression_of(std::string_view name);

// Keeps its memory from chunk to chunk.
class Compressor {
 public:
  explicit Compressor(Compression compression);
  ~Compressor();
  Compressor(const Compressor&) = delete;
  Compressor& operator=(const Compressor&) = delete;

  // The result is valid until the next call. Throws std::runtime_error.
  ByteView compress(const Bytes& bytes);

 private:
  struct Context;
  Compression compression_;
  std::unique_ptr<Context> context_;
  Bytes out_;
};

// Returns false unless the bytes unpack to exactly `size` bytes.
bool unpack(Compression compression, ByteView packed, std::size_t size, Bytes& out);

}  // namespace swiftlet::mcap
