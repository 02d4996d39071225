#include "swiftlet/io/ulog/ulog.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/io/config_error.hpp"

namespace swiftlet::ulog {
namespace {

using io::ByteReader;

constexpr std::string_view kMagic("ULog\x01\x12\x35", 7);
constexpr std::size_t kHeader = 16;
constexpr std::size_t kMessageHeader = 3;
constexpr std::size_t kFlags = 40;
constexpr int kDeepest = 8;  // nested formats
constexpr std::size_t kLongestMessage = 65'535;

struct Type {
  const char* name;
  char letter;
  std::size_t size;
};
constexpr std::array<Type, 12> kTypes{{{"int8_t", 'b', 1},
                                       {"uint8_t", 'B', 1},
                                       {"int16_t", 'h', 2},
                                       {"uint16_t", 'H', 2},
                                       {"int32_t", 'i', 4},
                                       {"uint32_t", 'I', 4},
                                       {"int64_t", 'q', 8},
                                       {"uint64_t", 'Q', 8},
                                       {"float", 'f', 4},
                                       {"double", 'd', 8},
                                       {"bool", 'B', 1},
                                       {"char", 'c', 1}}};

const Type* type_of(std::string_view name) {
  for (const Type& type : kTypes)
    if (name == type.name) return &type;
  return nullptr;
}

ByteReader reader_of(std::string_view bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), true};
}

double value_at(std::string_view message, char letter, std::size_t offset) {
  ByteReader in = reader_of(message.substr(offset));
  switch (letter) {
    case 'b':
      return static_cast<std::int8_t>(in.u8());
    case 'B':
      return in.u8();
    case 'h':
      return static_cast<std::int16_t>(in.u16());
    case 'H':
      return in.u16();
    case 'i':
      return in.i32();
    case 'I':
      return in.u32();
    case 'q':
      return static_cast<double>(static_cast<std::int64_t>(in.u64()));
    case 'Q':
      return static_cast<double>(in.u64());
    case 'f':
      return in.f32();
    default:
      return in.f64();
  }
}

// The number of elements of an array, "[4]". 0: the text is none, or the array is longer than a message.
std::size_t count_of(std::string_view brackets) {
  if (brackets.size() < 3 || brackets.back() != ']') return 0;
  std::size_t count = 0;
  for (const char c : brackets.substr(1, brackets.size() - 2)) {
    if (c < '0' || c > '9') return 0;
    count = 10 * count + static_cast<std::size_t>(c - '0');
    if (count > kLongestMessage) return 0;
  }
  return count;
}

std::size_t size_of(char letter) {
  for (const Type& type : kTypes)
    if (type.letter == letter) return type.size;
  return 0;
}

}  // namespace

Log::Log(std::string_view bytes, std::string file_name) : file_name_(std::move(file_name)) {
  if (bytes.size() < kHeader || bytes.substr(0, kMagic.size()) != kMagic) fail("is no ULog of PX4");
  std::size_t at = kHeader;
  while (at < bytes.size()) {
    // A section that is appended begins where the flags say, whether or not the message before it is whole.
    const auto next = std::upper_bound(appended_.begin(), appended_.end(), at);
    const std::size_t end = next == appended_.end() ? bytes.size() : std::min(*next, bytes.size());
    ByteReader in = reader_of(bytes.substr(at, end - at));
    const std::size_t size = in.u16();
    const char type = static_cast<char>(in.u8());
    if (!in.ok() || in.rest() < size) {
      ends_early_ = true;
      at = end;
      continue;
    }
    const std::string_view message = bytes.substr(at + kMessageHeader, size);
    at += kMessageHeader + size;
    if (type == 'D' && size >= 2) {
      data_[reader_of(message).u16()].push_back(message.substr(2));
    } else if (type == 'B') {
      read_flags(message, at);
    } else {
      read_definition(type, message);
    }
  }
  if (!appended_.empty() && appended_.back() >= bytes.size()) ends_early_ = true;
}

// 8 bytes of what a reader may ignore, 8 of what it may not, of which the first bit says that data is appended, and three offsets
// in the file at which such data begins; 0: none.
void Log::read_flags(std::string_view message, std::size_t next) {
  if (message.size() < kFlags) fail("has flags that are cut off");
  const std::string_view incompatible = message.substr(8, 8);
  for (std::size_t i = 0; i < incompatible.size(); ++i)
    if (static_cast<unsigned char>(incompatible[i]) > (i == 0 ? 1U : 0U))
      fail("uses features of ULog that are not known here");
  if (incompatible[0] == 0) return;
  ByteReader in = reader_of(message.substr(16));
  for (int i = 0; i < 3; ++i) {
    const std::uint64_t offset = in.u64();
    if (offset == 0) continue;
    if (offset < (appended_.empty() ? next : appended_.back()))
      fail("names appended data where other data is");
    appended_.push_back(offset);
  }
}

// Messages of other kinds, such as texts and drop-outs, are not needed.
void Log::read_definition(char type, std::string_view message) {
  switch (type) {
    case 'F':
      return read_format(message);
    case 'P':
      return read_parameter(message);
    case 'A':
      return read_subscription(message);
    default:
      return;
  }
}

// "name:type field;type[4] field;". Padding has fields of its own, "_padding0"; only at the end it is not logged.
void Log::read_format(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) fail("has a format without a name");
  std::vector<Field> fields;
  const std::string format(text.substr(0, colon));
  text.remove_prefix(colon + 1);
  while (!text.empty()) {
    const std::string_view field = text.substr(0, text.find(';'));
    text.remove_prefix(std::min(text.size(), field.size() + 1));
    if (field.empty()) continue;
    const std::size_t space = field.find(' ');
    const std::string_view type = field.substr(0, std::min(space, field.size()));
    const std::size_t bracket = std::min(type.find('['), type.size());
    Field out;
    out.type = type.substr(0, bracket);
    out.count = bracket == type.size() ? 1 : count_of(type.substr(bracket));
    if (space != std::string_view::npos) out.name = field.substr(space + 1);
    if (out.type.empty() || out.name.empty() || out.count == 0)
      fail("has a format that is not understood: " + format + ", field '" + std::string(field) + "'");
    fields.push_back(std::move(out));
  }
  formats_[format] = std::move(fields);
}

// The length of the key, the key "type name", the value.
void Log::read_parameter(std::string_view message) {
  ByteReader in = reader_of(message);
  const std::size_t length = in.u8();
  if (message.size() < 1 + length + 4) return;
  const std::string_view key = message.substr(1, length);
  const std::size_t space = key.find(' ');
  if (space == std::string_view::npos) return;
  const std::string_view type = key.substr(0, space);
  const std::string name(key.substr(space + 1));
  if (type == "float") parameters_.emplace(name, value_at(message, 'f', 1 + length));
  if (type == "int32_t") parameters_.emplace(name, value_at(message, 'i', 1 + length));
}

void Log::read_subscription(std::string_view message) {
  ByteReader in = reader_of(message);
  const std::uint8_t instance = in.u8();
  const std::uint16_t id = in.u16();
  if (in.ok() && instance == 0) topics_.emplace(std::string(message.substr(3)), id);
}

bool Log::has(const std::string& topic) const {
  const auto found = topics_.find(topic);
  return found != topics_.end() && data_.count(found->second) > 0;
}

// Returns the offset after the format.
std::size_t Log::lay_out(const std::string& format, const std::string& prefix, std::size_t offset, int depth,
                         Places& places) const {
  const auto found = formats_.find(format);
  if (found == formats_.end() || depth > kDeepest) fail("has no format of " + format);
  for (const Field& field : found->second) {
    const Type* const type = type_of(field.type);
    for (std::size_t i = 0; i < field.count; ++i) {
      const std::string name =
          prefix + field.name + (field.count > 1 ? fmt::format("[{}]", i) : std::string());
      if (type == nullptr) {
        offset = lay_out(field.type, name + ".", offset, depth + 1, places);
      } else {
        if (type->letter != 'c') places[name] = {type->letter, offset};
        offset += type->size;
      }
      if (offset > kLongestMessage) fail("has a format that is longer than a message: " + format);
    }
  }
  return offset;
}

Table Log::read(const std::string& topic, const std::vector<std::string>& fields) const {
  if (!has(topic)) fail("has no messages of topic " + topic);
  Places places;
  lay_out(topic, "", 0, 0, places);
  std::vector<Place> wanted{places["timestamp"]};
  if (wanted.front().type == 0) fail("topic " + topic + " has no timestamp");
  for (const std::string& field : fields) {
    const auto found = places.find(field);
    if (found == places.end()) fail("topic " + topic + " has no number " + field);
    wanted.push_back(found->second);
  }
  Table table;
  table.columns.resize(fields.size());
  double last_s = -std::numeric_limits<double>::infinity();
  for (const std::string_view message : data_.at(topics_.at(topic))) {
    bool whole = true;
    for (const Place& place : wanted) whole = whole && place.offset + size_of(place.type) <= message.size();
    if (!whole) continue;
    const double time_s = 1e-6 * value_at(message, wanted.front().type, wanted.front().offset);
    if (!(time_s > last_s)) continue;
    last_s = time_s;
    table.time_s.push_back(time_s);
    for (std::size_t i = 0; i < fields.size(); ++i)
      table.columns[i].push_back(value_at(message, wanted[i + 1].type, wanted[i + 1].offset));
  }
  if (table.rows() == 0) fail("has no message of topic " + topic + " that is as long as its format");
  return table;
}

double Log::parameter(const std::string& name) const {
  const auto found = parameters_.find(name);
  if (found == parameters_.end()) fail("has no parameter " + name);
  return found->second;
}

void Log::fail(const std::string& what) const { throw io::ConfigError(file_name_, 0, "", what); }

}  // namespace swiftlet::ulog
