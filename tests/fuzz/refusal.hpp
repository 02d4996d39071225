// What a parser may do with any input: read it, or refuse it with a sentence.
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

// Ends the process, as a sanitizer does, with what does not hold.
inline void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

constexpr const char* kFuzzedFile = "fuzzed";

// True if it was read. Exceptions other than the one for bad input files go through, and end the process.
template <class Parse>
bool is_read(const Parse& parse) {
  try {
    parse();
    return true;
  } catch (const runtime::ConfigError& error) {
    const std::string sentence = error.what();
    demand(sentence.rfind(kFuzzedFile, 0) == 0, "a refusal names the file");
    demand(sentence.size() > error.file().size() + error.key().size() + 6, "a refusal says what is wrong");
    demand(error.line() >= 0, "a refusal's line");
    return false;
  }
}

}  // namespace swiftlet::tests
