// An invalid file and the message it is refused with.
#pragma once

#include <ostream>
#include <string>

#include <gtest/gtest.h>

namespace swiftlet::tests {

struct Fault {
  const char* name;
  std::string text;
  std::string sentence;
};

inline void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }
inline std::string name_of(const testing::TestParamInfo<Fault>& fault) { return fault.param.name; }

}  // namespace swiftlet::tests
