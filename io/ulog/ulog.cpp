#include "swiftlet/io/ulog/ulog.hpp"

#include <array>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/io/config_error.hpp"

namespace swiftlet::ulog {
namespace {

using runtime::ByteReader;

constexpr std::string_view kMagic("ULog\x01\x12\x35", 7);
constexpr std::size_t kHeader = 16;
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

std::size_t size_of(char letter) {
  for (const Type& type : kTypes)
    if (type.letter == letter) return type.size;
  return 0;
}

}  // namespace

Log::Log(std::string_view bytes, std::string file_name) : file_name_(std::move(file_name)) {
  if (bytes.size() < kHeader || bytes.substr(0, kMagic.size()) != kMagic) fail("is no ULog of PX4");
  std::string_view rest = bytes.substr(kHeader);
  while (!rest.empty()) {
    ByteReader in = reader_of(rest);
    const std::size_t size = in.u16();
    const char type = static_cast<char>(in.u8());
    if (!in.ok() || in.rest() < size) {
      ends_early_ = true;
      return;
    }
    const std::string_view message = rest.substr(3, size);
    rest.remove_prefix(3 + size);
    if (type == 'D' && size >= 2) {
      data_[reader_of(message).u16()].push_back(message.substr(2));
    } else {
      read_definition(type, message);
    }
  }
}

// Messages of other kinds, such as texts and drop-outs, are not needed.
void Log::read_definition(char type, std::string_view message) {
  switch (type) {
    case 'B': {  // flag bits: 8 of what a reader may ignore, 8 of what it may not; 1: data is appended to the file
      const auto incompatible = message.size() < 40 ? std::string_view() : message.substr(8, 8);
      for (std::size_t i = 0; i < incompatible.size(); ++i)
        if (static_cast<unsigned char>(incompatible[i]) > (i == 0 ? 1U : 0U))
          fail("uses features of ULog that are not known here");
      return;
    }
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

// "name:type field;type[4] field;"
void Log::read_format(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) fail("has a format without a name");
  std::vector<Field> fields;
  const std::string format(text.substr(0, colon));
  text.remove_prefix(colon + 1);
  while (!text.empty()) {
    const std::string_view field = text.substr(0, text.find(';'));
    text.remove_prefix(std::min(text.size(), field.size() + 1));
    const std::size_t space = field.find(' ');
    if (space == std::string_view::npos) fail("has a format that is not understood: " + format);
    Field out;
    out.name = field.substr(space + 1);
    const std::string_view type = field.substr(0, space);
    const std::size_t bracket = type.find('[');
    out.type = type.substr(0, bracket);
    if (bracket != std::string_view::npos) {
      out.count = 0;
      for (const char c : type.substr(bracket + 1)) {
        if (c < '0' || c > '9' || out.count > kLongestMessage) break;
        out.count = 10 * out.count + static_cast<std::size_t>(c - '0');
      }
    }
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
  return table;
}

double Log::parameter(const std::string& name) const {
  const auto found = parameters_.find(name);
  if (found == parameters_.end()) fail("has no parameter " + name);
  return found->second;
}

void Log::fail(const std::string& what) const { throw runtime::ConfigError(file_name_, 0, "", what); }

}  // namespace swiftlet::ulog
