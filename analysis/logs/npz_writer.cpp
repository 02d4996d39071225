#include "swiftlet/analysis/logs/npz_writer.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include <fmt/core.h>

#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/byte_writer.hpp"
#include "swiftlet/record/mcap/record_writer.hpp"

namespace swiftlet::analysis {
namespace {

// ZIP, as in the application note of PKWARE: signatures, and the version that a reader needs.
constexpr std::uint32_t kLocalHeader = 0x04034b50;
constexpr std::uint32_t kCentralHeader = 0x02014b50;
constexpr std::uint32_t kEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 20;
constexpr std::uint16_t kFirstDay = 0x21;  // 1980-01-01
constexpr std::size_t kNpyAlignment = 64;

void put16(std::string& out, std::size_t value) { io::append(out, static_cast<std::uint16_t>(value)); }
void put32(std::string& out, std::size_t value) { io::append(out, static_cast<std::uint32_t>(value)); }

// What local and central header have in common: flags, method (stored), time, date, CRC, sizes, length of the name.
void put_common(std::string& out, std::uint32_t crc, std::uint32_t size, std::size_t name_size) {
  put16(out, 0);
  put16(out, 0);
  put16(out, 0);
  put16(out, kFirstDay);
  put32(out, crc);
  put32(out, size);
  put32(out, size);
  put16(out, name_size);
}

// The header of a .npy file, version 1.0, padded so that the data are aligned.
std::string npy_header(const std::string& type, std::size_t rows, std::size_t columns) {
  const std::string shape =
      columns == 1 ? fmt::format("({},)", rows) : fmt::format("({}, {})", rows, columns);
  std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", type, shape);
  constexpr std::size_t kFixed = 10;  // magic, version, length
  text.append((kNpyAlignment - (kFixed + text.size() + 1) % kNpyAlignment) % kNpyAlignment, ' ');
  text.push_back('\n');
  std::string header = "\x93NUMPY";
  put16(header, 1);  // the version: 1.0
  put16(header, text.size());
  return header + text;
}

std::uint32_t crc_of(const std::string& bytes) {
  return mcap::crc32({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

}  // namespace

void NpzWriter::add_array(const std::string& name, const std::string& type, std::size_t count,
                          std::size_t columns, const void* data, std::size_t bytes) {
  std::string content = npy_header(type, count / columns, columns);
  content.append(static_cast<const char*>(data), bytes);
  if (archive_.size() + content.size() > std::numeric_limits<std::uint32_t>::max() - (1U << 20U) ||
      entries_.size() == std::numeric_limits<std::uint16_t>::max())
    throw std::runtime_error("the archive would be larger than 4 GB; choose topics or a shorter time");
  entries_.push_back({name + ".npy", crc_of(content), static_cast<std::uint32_t>(content.size()),
                      static_cast<std::uint32_t>(archive_.size())});
  const Entry& entry = entries_.back();
  put32(archive_, kLocalHeader);
  put16(archive_, kVersion);
  put_common(archive_, entry.crc, entry.size, entry.name.size());
  put16(archive_, 0);  // extra field
  archive_ += entry.name + content;
}

void NpzWriter::add(const std::string& name, const std::vector<double>& values, std::size_t columns) {
  add_array(name, "<f8", values.size(), columns, values.data(), values.size() * sizeof(double));
}
void NpzWriter::add(const std::string& name, const std::vector<std::int64_t>& values, std::size_t columns) {
  add_array(name, "<i8", values.size(), columns, values.data(), values.size() * sizeof(std::int64_t));
}
void NpzWriter::add(const std::string& name, const std::vector<std::uint64_t>& values, std::size_t columns) {
  add_array(name, "<u8", values.size(), columns, values.data(), values.size() * sizeof(std::uint64_t));
}
void NpzWriter::add(const std::string& name, const std::vector<std::string>& values) {
  std::size_t width = 1;
  for (const std::string& value : values) width = std::max(width, value.size());
  std::string cells;
  for (const std::string& value : values) cells += value + std::string(width - value.size(), '\0');
  add_array(name, fmt::format("|S{}", width), values.size(), 1, cells.data(), cells.size());
}

void NpzWriter::write(const std::filesystem::path& file) const {
  std::string whole = archive_;
  for (const Entry& entry : entries_) {
    put32(whole, kCentralHeader);
    put16(whole, kVersion);
    put16(whole, kVersion);
    put_common(whole, entry.crc, entry.size, entry.name.size());
    whole.append(12, '\0');  // extra field, comment, disk, attributes
    put32(whole, entry.offset);
    whole += entry.name;
  }
  const std::size_t central_size = whole.size() - archive_.size();
  put32(whole, kEnd);
  put32(whole, 0);  // disks
  put16(whole, entries_.size());
  put16(whole, entries_.size());
  put32(whole, central_size);
  put32(whole, archive_.size());
  put16(whole, 0);  // comment
  io::write_atomically(file, whole);
}

}  // namespace swiftlet::analysis
