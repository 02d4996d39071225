// control/supervision/README.md shows the table that the code runs.
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/supervision/transitions.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::control::transitions_document_test {

const std::string kFile = tests::in_source("control/supervision/README.md");
const std::string kBegin = "<!-- table: written by control_test -->\n";
const std::string kEnd = "<!-- end of the table -->\n";

std::string text_of(const ModeSet& modes) {
  std::string text;
  int count = 0;
  for (int i = 0; i < kModeCount; ++i) {
    const auto mode = static_cast<Mode>(i);
    if (!modes.has(mode)) continue;
    text += (count++ == 0 ? "" : ", ") + std::string(to_string(mode));
  }
  return count == kModeCount ? "any" : text;
}

std::string table() {
  std::ostringstream text;
  text << "| | in mode | event | when | provided | to | reason | and |\n|---|---|---|---|---|---|---|---|\n";
  int number = 0;
  for (const Transition& row : transitions()) {
    text << "| " << ++number << " | " << text_of(row.from) << " | "
         << (is_request(row.event) ? "*" + std::string(to_string(row.event)) + "*" : to_string(row.event))
         << " | " << row.guards.text << " | " << row.provided.text << " | "
         << (row.to.stays ? "" : std::string("**") + to_string(row.to.mode) + "**") << " | "
         << (row.to.stays ? "" : to_string(row.reason)) << " | " << row.action.text << " |\n";
  }
  return text.str();
}

TEST(TransitionsDocument, ShowsTheTableOfTheCode) {
  std::ifstream in(kFile);
  const std::string document{std::istreambuf_iterator<char>(in), {}};
  const std::size_t begin = document.find(kBegin);
  const std::size_t end = document.find(kEnd);
  ASSERT_NE(begin, std::string::npos) << kFile;
  ASSERT_NE(end, std::string::npos) << kFile;
  const std::size_t first = begin + kBegin.size();
  if (document.substr(first, end - first) == table()) return;
  const std::string written = testing::TempDir() + "supervision.md";
  std::ofstream(written) << document.substr(0, first) << table() << document.substr(end);
  FAIL() << "control/supervision/README.md differs from the code's table: copy " << written << " there";
}

}  // namespace swiftlet::control::transitions_document_test
