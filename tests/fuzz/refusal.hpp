// Expectation of every parser: it reads an input or refuses it with a message.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::tests {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// Aborts the process with a message unless `holds`.
inline void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

constexpr const char* kFuzzedFile = "fuzzed";

// Returns true if the input was read, false if refused with a ConfigError. Other exceptions end the process.
template <class Parse>
bool is_read(const Parse& parse) {
  try {
    parse();
    return true;
  } catch (const io::ConfigError& error) {
    const std::string sentence = error.what();
    demand(sentence.rfind(kFuzzedFile, 0) == 0, "a refusal names the file");
    demand(sentence.size() > error.file().size() + error.key().size() + 6, "a refusal says what is wrong");
    demand(error.line() >= 0, "a refusal has a line");
    return false;
  }
}

}  // namespace swiftlet::tests
