// Writes logs as PX4 does, for tests: header, formats, parameters, then subscriptions and data.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "swiftlet/io/byte_writer.hpp"

namespace swiftlet::tests {

class UlogWriter {
 public:
  UlogWriter() {
    bytes_.assign("ULog\x01\x12\x35\x01", 8);
    add(std::uint64_t{0});
    std::string flags(40, '\0');
    message('B', flags);
  }

  // definition: "name:uint64_t timestamp;float z;"
  void format(const std::string& definition) { message('F', definition); }
  void parameter(const std::string& name, float value) {
    const std::string key = "float " + name;
    message('P', std::string(1, static_cast<char>(key.size())) + key + raw(value));
  }
  void subscribe(std::uint16_t id, const std::string& topic, std::uint8_t instance = 0) {
    message('A', std::string(1, static_cast<char>(instance)) + raw(id) + topic);
  }
  // fields: what follows the stamp, packed.
  void data(std::uint16_t id, std::uint64_t stamp_us, const std::string& fields) {
    message('D', raw(id) + raw(stamp_us) + fields);
  }
  void message(char type, const std::string& text) {
    add(static_cast<std::uint16_t>(text.size()));
    bytes_ += type;
    bytes_ += text;
  }
  template <class Value>
  static std::string raw(Value value) {
    std::string out;
    io::append(out, value);
    return out;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  template <class Value>
  void add(Value value) {
    bytes_ += raw(value);
  }

  std::string bytes_;
};

}  // namespace swiftlet::tests
