#include "swiftlet/record/mcap/compression.hpp"

#include <algorithm>
#include <lz4frame.h>
#include <stdexcept>
#include <string>
#include <zstd.h>

namespace swiftlet::mcap {
namespace {

constexpr int kZstdLevel = 1;  // its fastest: half the size is there, a higher level costs the recorder time

// A chunk that claims to unpack to more than what it holds could hold is refused before memory is taken for it.
constexpr std::size_t kLargestRatio = 20000;
constexpr std::size_t kLargestChunk = std::size_t{1} << 30;

bool unpack_lz4(ByteView packed, std::size_t size, Bytes& out) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) return false;
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, LZ4F_freeDecompressionContext);
  std::size_t read = 0;
  std::size_t written = 0;
  while (true) {
    std::size_t room = size - written;
    std::size_t left = packed.size - read;
    const std::size_t more =
        LZ4F_decompress(context.get(), out.data() + written, &room, packed.data + read, &left, nullptr);
    if (LZ4F_isError(more) != 0) return false;
    read += left;
    written += room;
    if (more == 0) return read == packed.size && written == size;
    if (left == 0 && room == 0) return false;  // cut, or longer than `size`
  }
}

}  // namespace

const char* to_string(Compression compression) {
  switch (compression) {
    case Compression::kNone:
      return "";
    case Compression::kZstd:
      return "zstd";
    case Compression::kLz4:
      return "lz4";
  }
  return "";
}

std::optional<Compression> compression_of(std::string_view name) {
  for (const Compression known : {Compression::kNone, Compression::kZstd, Compression::kLz4}) {
    if (name == to_string(known)) return known;
  }
  return std::nullopt;
}

struct Compressor::Context {
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> zstd{ZSTD_createCCtx(), ZSTD_freeCCtx};
};

Compressor::Compressor(Compression compression)
    : compression_(compression), context_(std::make_unique<Context>()) {}
Compressor::~Compressor() = default;

ByteView Compressor::compress(const Bytes& bytes) {
  if (compression_ == Compression::kNone) return {bytes.data(), bytes.size()};
  std::size_t size = 0;
  if (compression_ == Compression::kZstd) {
    out_.resize(ZSTD_compressBound(bytes.size()));
    size = ZSTD_compressCCtx(context_->zstd.get(), out_.data(), out_.size(), bytes.data(), bytes.size(),
                             kZstdLevel);
    if (ZSTD_isError(size) != 0)
      throw std::runtime_error(std::string("zstd cannot compress: ") + ZSTD_getErrorName(size));
  } else {
    out_.resize(LZ4F_compressFrameBound(bytes.size(), nullptr));
    size = LZ4F_compressFrame(out_.data(), out_.size(), bytes.data(), bytes.size(), nullptr);
    if (LZ4F_isError(size) != 0)
      throw std::runtime_error(std::string("lz4 cannot compress: ") + LZ4F_getErrorName(size));
  }
  return {out_.data(), size};
}

bool unpack(Compression compression, ByteView packed, std::size_t size, Bytes& out) {
  if (size > kLargestChunk || size / kLargestRatio > packed.size) return false;
  if (compression == Compression::kNone) {
    out.assign(packed.data, packed.data + packed.size);
    return packed.size == size;
  }
  out.resize(size);
  if (compression == Compression::kLz4) return unpack_lz4(packed, size, out);
  const std::size_t written = ZSTD_decompress(out.data(), out.size(), packed.data, packed.size);
  return ZSTD_isError(written) == 0 && written == size;
}

}  // namespace swiftlet::mcap
