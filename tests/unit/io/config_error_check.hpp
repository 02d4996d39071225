// Catches the ConfigError of a refused input.
#pragma once

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::tests {

// The whole sentence of the ConfigError that work throws; fails the test if it throws none.
inline std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const io::ConfigError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no ConfigError was thrown";
  return "";
}

}  // namespace swiftlet::tests
