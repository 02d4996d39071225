#include "swiftlet/io/ulog/ulog.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
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
constexpr std::string_view kKinds = "BFIMPQARDLCSO";  // of messages
constexpr std::size_t kLongestPadding = 7;            // at the end of a format, which is not logged
constexpr int kMessagesInARow = 4;

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

struct Message {
  char type = 0;
  std::string_view content;
};

// The one at the start of the bytes; nullopt: none is there, or they end within it. Types not known here are capitals too.
std::optional<Message> message_at(std::string_view bytes) {
  ByteReader in = reader_of(bytes);
  const std::size_t size = in.u16();
  const char type = static_cast<char>(in.u8());
  if (!in.ok() || in.rest() < size || size == 0 || type < 'A' || type > 'Z') return std::nullopt;
  return Message{type, bytes.substr(kMessageHeader, size)};
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

Log::Log(std::string_view bytes, std::string file_name) : bytes_(bytes), file_name_(std::move(file_name)) {
  if (bytes.size() < kHeader || bytes.substr(0, kMagic.size()) != kMagic) fail("is no ULog of PX4");
  read_messages();
  if (!appended_.empty() && appended_.back() >= bytes.size()) ends_early_ = true;
}

void Log::read_messages() {
  std::size_t at = kHeader;
  while (at < bytes_.size()) {
    // A section that is appended begins where the flags say, whether or not the message before it is whole.
    const auto next = std::upper_bound(appended_.begin(), appended_.end(), at);
    const std::size_t end = next == appended_.end() ? bytes_.size() : std::min(*next, bytes_.size());
    const auto message = message_at(bytes_.substr(at, end - at));
    if (!message) {
      const std::size_t found = next_messages(at, end);
      found == end ? static_cast<void>(ends_early_ = true) : note_loss(at, found - at);
      at = found;
      continue;
    }
    at += kMessageHeader + message->content.size();
    if (message->type == 'D' && message->content.size() >= 2) {
      note_data(message->content);
      continue;
    }
    if (last_) before_ = std::exchange(last_, std::nullopt);
    if (message->type == 'B') {
      read_flags(message->content, at);
    } else {
      read_definition(message->type, message->content);
    }
  }
}

void Log::note_data(std::string_view message) {
  if (last_) before_ = last_;
  last_ = Data{reader_of(message).u16(), message.substr(2)};
  data_[last_->subscription].push_back(last_->fields);
  if (std::exchange(loss_has_no_end_, false)) losses_.back().until_s = stamp_s(*last_);
}

// Drops the message before, in which the loss may begin.
void Log::note_loss(std::size_t at, std::size_t bytes) {
  if (last_) {
    std::vector<std::string_view>& same = data_[last_->subscription];
    same.pop_back();
    if (same.empty()) data_.erase(last_->subscription);
    last_.reset();
  }
  losses_.push_back({at, bytes, before_ ? stamp_s(*before_) : 0.0, 0.0});
  loss_has_no_end_ = true;
}

// Milliseconds in which PX4 could not write.
void Log::note_dropout(std::string_view message) {
  ByteReader in = reader_of(message);
  const double time_s = 1e-3 * in.u16();
  lay_out_subscriptions();
  const double from_s = before_ ? stamp_s(*before_) : 0.0;
  if (in.ok()) losses_.push_back({0, 0, from_s, from_s + time_s});
}

void Log::lay_out_subscriptions() {
  for (const auto& [id, topic] : subscriptions_) {
    Places places;
    try {
      layouts_[id].size = lay_out(topic, "", 0, 0, places);
      layouts_[id].stamp = places["timestamp"].offset;
    } catch (const io::ConfigError&) {
      layouts_.erase(id);  // whoever reads the topic is told
    }
  }
}

double Log::stamp_s(const Data& data) const {
  const auto layout = layouts_.find(data.subscription);
  if (layout == layouts_.end() || layout->second.stamp + 8 > data.fields.size()) return 0.0;
  return 1e-6 * value_at(data.fields, 'Q', layout->second.stamp);
}

std::size_t Log::next_messages(std::size_t at, std::size_t end) {
  lay_out_subscriptions();
  while (++at < end && !begins_messages(at, end)) {
  }
  return at;
}

// True for several messages in a row of kinds and lengths that the definitions allow, one of them with data.
bool Log::begins_messages(std::size_t at, std::size_t end) const {
  bool has_data = false;
  for (int i = 0; i < kMessagesInARow && (i == 0 || at < end); ++i) {
    const auto message = message_at(bytes_.substr(at, end - at));
    if (!message || kKinds.find(message->type) == std::string_view::npos) return false;
    at += kMessageHeader + message->content.size();
    if (message->type != 'D') continue;
    if (message->content.size() < 2) return false;
    const auto layout = layouts_.find(reader_of(message->content).u16());
    const std::size_t size = message->content.size() - 2;
    if (layout == layouts_.end() || size > layout->second.size ||
        size + kLongestPadding < layout->second.size)
      return false;
    has_data = true;
  }
  return has_data;
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

// Messages of other kinds, such as texts, are not needed.
void Log::read_definition(char type, std::string_view message) {
  switch (type) {
    case 'F':
      return read_format(message);
    case 'P':
      return read_parameter(message);
    case 'A':
      return read_subscription(message);
    case 'O':
      return note_dropout(message);
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
  if (!in.ok()) return;
  subscriptions_[id] = message.substr(3);
  if (instance == 0) topics_.emplace(subscriptions_[id], id);
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
