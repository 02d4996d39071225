// What Vicon Tracker sends as its UDP object stream. Written from the protocol, apart from the parser.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace swiftlet::tests {

struct ViconObject {
  std::string name;
  double numbers[6] = {};  // mm, rad
};

inline std::vector<std::uint8_t> vicon_frame(std::uint32_t number, const std::vector<ViconObject>& objects,
                                             std::size_t block) {
  std::vector<std::uint8_t> out;
  const auto put = [&](auto value) {
    std::uint8_t bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    out.insert(out.end(), bytes, bytes + sizeof value);
  };
  put(number);
  put(static_cast<std::uint8_t>(objects.size()));
  for (const ViconObject& object : objects) {
    put(std::uint8_t{0});
    put(std::uint16_t{72});
    std::string name = object.name;
    name.resize(24);
    out.insert(out.end(), name.begin(), name.end());
    for (const double value : object.numbers) put(value);
  }
  out.resize(block);
  return out;
}

}  // namespace swiftlet::tests
