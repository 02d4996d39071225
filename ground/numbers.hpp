// Checks of numbers on the command line. CLI11's own let "nan" through.
#pragma once

#include <cmath>
#include <string>

#include <CLI/CLI.hpp>

namespace swiftlet::ground {

inline CLI::Validator finite_number() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        double value = 0.0;
        return CLI::detail::lexical_cast(text, value) && std::isfinite(value)
                   ? ""
                   : text + " is not a finite number";
      },
      "NUMBER");
}

inline CLI::Validator positive_number() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        double value = 0.0;
        return CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0.0
                   ? ""
                   : text + " must be a finite number above 0";
      },
      "NUMBER > 0");
}

}  // namespace swiftlet::ground
