#include "swiftlet/record/mcap/message_decoder.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::mcap {
namespace {

constexpr int kDeepest = 8;                 // messages within messages
constexpr std::size_t kMostColumns = 4096;  // of one message

[[noreturn]] void refuse(const Schema& schema, int line, const std::string& what) {
  throw io::ConfigError(schema.name, line, "", what);
}

// "geometry_msgs/msg/Point" and "geometry_msgs/Point" are the same.
std::string short_name(const std::string& name) {
  const std::size_t at = name.find("/msg/");
  return at == std::string::npos ? name : name.substr(0, at) + name.substr(at + 4);
}

std::string package_of(const std::string& short_name) { return short_name.substr(0, short_name.find('/')); }

// Without comment and surrounding blanks.
std::string content_of(const std::string& line) {
  const std::string text = line.substr(0, line.find('#'));
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::size_t number_of(const Schema& schema, int line, const std::string& digits) {
  if (digits.empty() || digits.size() > 6 || digits.find_first_not_of("0123456789") != std::string::npos)
    refuse(schema, line, "the length '" + digits + "' is not a number below 1000000");
  return std::stoul(digits);
}

}  // namespace

MessageDecoder::MessageDecoder(const Schema& schema) : name_(short_name(schema.name)) {
  if (schema.encoding != "ros2msg")
    refuse(schema, 0, "has the encoding '" + schema.encoding + "', must be ros2msg");
  parse(schema);
  add_columns(schema, types_.at(name_), "");
}

void MessageDecoder::parse(const Schema& schema) {
  std::vector<std::pair<std::string, std::vector<std::pair<int, std::string>>>> parts = {{name_, {}}};
  std::istringstream text(schema.data);
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    const std::string content = content_of(line);
    if (content.rfind("===", 0) == 0) continue;
    if (content.rfind("MSG:", 0) == 0) {
      parts.push_back({short_name(content_of(content.substr(4))), {}});
    } else if (!content.empty() && content.find('=') == std::string::npos) {
      parts.back().second.push_back({number, content});
    } else if (content.find("<=") != std::string::npos) {  // no constant, but a bound
      parts.back().second.push_back({number, content});
    }
  }
  for (const auto& part : parts) types_[part.first];
  for (const auto& [name, lines] : parts) {
    Members members;
    for (const auto& [line, content] : lines) members.push_back(parse_member(schema, line, content));
    types_[name] = std::move(members);
  }
  check_types(schema);
}

// Every message has members, and none contains itself: reading ends.
void MessageDecoder::check_types(const Schema& schema) const {
  std::map<std::string, int> depths;
  for (int round = 0; round <= kDeepest; ++round) {
    bool changed = false;
    for (const auto& [name, members] : types_) {
      if (members.empty()) refuse(schema, 0, "the message '" + name + "' has no members");
      int deepest = 0;
      for (const Member& member : members) {
        if (member.type == Type::kCompound) deepest = std::max(deepest, depths[member.compound] + 1);
      }
      changed = changed || depths[name] != deepest;
      depths[name] = deepest;
    }
    if (!changed) return;
  }
  refuse(schema, 0, "nests messages more than " + std::to_string(kDeepest) + " deep");
}

MessageDecoder::Member MessageDecoder::parse_member(const Schema& schema, int line,
                                                    const std::string& text) const {
  static const std::map<std::string, Type> kPrimitives = {
      {"bool", Type::kBool},   {"byte", Type::kU8},    {"char", Type::kU8},    {"uint8", Type::kU8},
      {"uint16", Type::kU16},  {"uint32", Type::kU32}, {"uint64", Type::kU64}, {"int8", Type::kI8},
      {"int16", Type::kI16},   {"int32", Type::kI32},  {"int64", Type::kI64},  {"float32", Type::kF32},
      {"float64", Type::kF64}, {"string", Type::kText}};
  std::istringstream words(text);
  std::string type;
  Member member;
  words >> type >> member.name;
  if (member.name.empty()) refuse(schema, line, "'" + text + "' is not a member");
  if (const std::size_t bracket = type.find('['); bracket != std::string::npos) {
    if (type.back() != ']') refuse(schema, line, "'" + type + "' is not a type");
    const std::string length = type.substr(bracket + 1, type.size() - bracket - 2);
    type.resize(bracket);
    member.count = length.empty() || length[0] == '<' ? Count::kSequence : Count::kArray;
    if (member.count == Count::kArray) member.length = number_of(schema, line, length);
  }
  type = type.substr(0, type.find("<="));  // the bound of a string
  const auto primitive = kPrimitives.find(type);
  if (primitive != kPrimitives.end()) {
    member.type = primitive->second;
    return member;
  }
  member.type = Type::kCompound;
  member.compound = short_name(type.find('/') == std::string::npos ? package_of(name_) + "/" + type : type);
  if (types_.count(member.compound) == 0) refuse(schema, line, "the type '" + type + "' is not known");
  return member;
}

Column::Kind MessageDecoder::kind_of(Type type) {
  switch (type) {
    case Type::kF32:
    case Type::kF64:
      return Column::Kind::kFloat;
    case Type::kI8:
    case Type::kI16:
    case Type::kI32:
    case Type::kI64:
      return Column::Kind::kSigned;
    case Type::kText:
      return Column::Kind::kText;
    default:
      return Column::Kind::kUnsigned;
  }
}

void MessageDecoder::add_column(const Schema& schema, std::string name, Column::Kind kind) {
  if (columns_.size() == kMostColumns)
    refuse(schema, 0, "has more than " + std::to_string(kMostColumns) + " signals");
  columns_.push_back({std::move(name), kind});
}

void MessageDecoder::add_columns(const Schema& schema, const Members& members, const std::string& prefix) {
  for (const Member& member : members) {
    const std::string name = prefix + member.name;
    if (member.count == Count::kSequence) {
      add_column(schema, name + ".length", Column::Kind::kUnsigned);
      continue;
    }
    for (std::size_t i = 0; i < member.length; ++i) {
      const std::string item = member.count == Count::kArray ? name + "[" + std::to_string(i) + "]" : name;
      if (member.type == Type::kCompound) {
        add_columns(schema, types_.at(member.compound), item + ".");
      } else {
        add_column(schema, item, kind_of(member.type));
      }
    }
  }
}

bool MessageDecoder::decode(ByteView payload, std::vector<Value>& values) const {
  values.clear();
  CdrReader in(payload);
  return read(in, types_.at(name_), &values) && values.size() == columns_.size();
}

// values: null to skip.
bool MessageDecoder::read(CdrReader& in, const Members& members, std::vector<Value>* values) const {
  for (const Member& member : members) {
    std::size_t count = member.length;
    std::vector<Value>* items = values;
    if (member.count == Count::kSequence) {
      count = in.number<std::uint32_t>();
      if (values != nullptr) values->emplace_back(std::uint64_t{count});
      items = nullptr;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!in.ok() || !read_one(in, member, items)) return false;
    }
  }
  return in.ok();
}

bool MessageDecoder::read_one(CdrReader& in, const Member& member, std::vector<Value>* values) const {
  const auto keep = [&](auto value) {
    if (values != nullptr) values->emplace_back(std::move(value));
  };
  switch (member.type) {
    case Type::kCompound:
      return read(in, types_.at(member.compound), values);
    case Type::kBool:
    case Type::kU8:
      keep(std::uint64_t{in.number<std::uint8_t>()});
      break;
    case Type::kU16:
      keep(std::uint64_t{in.number<std::uint16_t>()});
      break;
    case Type::kU32:
      keep(std::uint64_t{in.number<std::uint32_t>()});
      break;
    case Type::kU64:
      keep(in.number<std::uint64_t>());
      break;
    case Type::kI8:
      keep(std::int64_t{in.number<std::int8_t>()});
      break;
    case Type::kI16:
      keep(std::int64_t{in.number<std::int16_t>()});
      break;
    case Type::kI32:
      keep(std::int64_t{in.number<std::int32_t>()});
      break;
    case Type::kI64:
      keep(in.number<std::int64_t>());
      break;
    case Type::kF32:
      keep(double{in.number<float>()});
      break;
    case Type::kF64:
      keep(in.number<double>());
      break;
    case Type::kText:
      keep(std::string(in.text()));
      break;
  }
  return in.ok();
}

}  // namespace swiftlet::mcap
