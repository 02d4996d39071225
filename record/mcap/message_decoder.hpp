// Decodes recorded messages by the definition in their schema: message encoding cdr, schema encoding ros2msg.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "swiftlet/record/mcap/cdr_reader.hpp"
#include "swiftlet/record/mcap/records.hpp"

namespace swiftlet::mcap {

using Value = std::variant<double, std::int64_t, std::uint64_t, std::string>;

// A signal of a message: "position_ned[0]", "pose.position.x". Of a sequence only its length: "items.length".
struct Column {
  enum class Kind { kFloat, kSigned, kUnsigned, kText };
  std::string name;
  Kind kind = Kind::kFloat;

  bool operator==(const Column& other) const { return name == other.name && kind == other.kind; }
};

class MessageDecoder {
 public:
  // Throws ConfigError with the name of the schema if its definition is not understood.
  explicit MessageDecoder(const Schema& schema);

  const std::vector<Column>& columns() const { return columns_; }

  // One value for each column. Returns false if the payload is not such a message.
  bool decode(ByteView payload, std::vector<Value>& values) const;

 private:
  enum class Type { kBool, kU8, kU16, kU32, kU64, kI8, kI16, kI32, kI64, kF32, kF64, kText, kCompound };
  enum class Count { kOne, kArray, kSequence };
  struct Member {
    Type type = Type::kF64;
    std::string compound;  // key into types_
    std::string name;
    Count count = Count::kOne;
    std::size_t length = 1;  // of an array
  };
  using Members = std::vector<Member>;

  void parse(const Schema& schema);
  Member parse_member(const Schema& schema, int line, const std::string& text) const;
  void check_types(const Schema& schema) const;
  void add_columns(const Schema& schema, const Members& members, const std::string& prefix);
  void add_column(const Schema& schema, std::string name, Column::Kind kind);
  bool read(CdrReader& in, const Members& members, std::vector<Value>* values) const;
  bool read_one(CdrReader& in, const Member& member, std::vector<Value>* values) const;
  static Column::Kind kind_of(Type type);

  std::string name_;
  std::map<std::string, Members> types_;  // by "package/Name"
  std::vector<Column> columns_;
};

}  // namespace swiftlet::mcap
