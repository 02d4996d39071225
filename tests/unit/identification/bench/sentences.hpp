// What identification says.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::tests {

// The sentence with which data are refused; fails the test if they are not.
template <class Fault = identification::BadData>
std::string refused(const std::function<void()>& work) {
  try {
    work();
  } catch (const Fault& fault) {
    return fault.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

// Whether one of the sentences holds this part; says all if not.
inline testing::AssertionResult contains(const std::vector<std::string>& sentences, const std::string& part) {
  testing::AssertionResult none = testing::AssertionFailure() << "none holds \"" << part << "\":";
  for (const std::string& sentence : sentences) {
    if (sentence.find(part) != std::string::npos) return testing::AssertionSuccess() << sentence;
    none << "\n" << sentence;
  }
  return none;
}

}  // namespace swiftlet::tests
