// Expectations of the messages of identification.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::tests {

// The message of the Fault that work() throws; fails the test if it throws none.
template <class Fault = identification::BadData>
std::string refused(const std::function<void()>& work) {
  try {
    work();
  } catch (const Fault& fault) {
    return fault.what();
  }
  ADD_FAILURE() << "expected an exception";
  return "";
}

// Whether one of the sentences contains this part; lists them all if not.
inline testing::AssertionResult contains(const std::vector<std::string>& sentences, const std::string& part) {
  testing::AssertionResult none = testing::AssertionFailure() << "none contains \"" << part << "\":";
  for (const std::string& sentence : sentences) {
    if (sentence.find(part) != std::string::npos) return testing::AssertionSuccess() << sentence;
    none << "\n" << sentence;
  }
  return none;
}

}  // namespace swiftlet::tests
