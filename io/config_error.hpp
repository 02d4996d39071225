// The exception for invalid input files: vehicle, settings, missions, CSV.
#pragma once

#include <stdexcept>
#include <string>

#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {

// what() is one sentence: "FILE:LINE: KEY: is VALUE, must be LIMIT". It omits a line of 0 and an empty key,
// and is printable().
class ConfigError : public std::runtime_error {
 public:
  ConfigError(const std::string& file, int line, const std::string& key, const std::string& message)
      : std::runtime_error(printable(file + (line > 0 ? ":" + std::to_string(line) : "") + ": " +
                                     (key.empty() ? "" : key + ": ") + message)),
        file_(file),
        line_(line),
        key_(key) {}

  // A sentence that is not about the content of a file.
  explicit ConfigError(const std::string& sentence) : std::runtime_error(printable(sentence)) {}

  const std::string& file() const { return file_; }
  int line() const { return line_; }               // from 1; 0: the file as a whole
  const std::string& key() const { return key_; }  // "motor.time_constant", "rotors[2].spin"; may be empty

 private:
  std::string file_;
  int line_ = 0;
  std::string key_;
};

}  // namespace swiftlet::io
