#include "swiftlet/ground/cli/check/operator_dialog.hpp"

#include <cstdio>
#include <poll.h>
#include <stdexcept>
#include <unistd.h>
#include <utility>

namespace swiftlet::ground {
namespace {

constexpr int kStep_ms = 100;

// Waits for input. Returns false after kStep_ms.
bool input_waits() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  return poll(&input, 1, kStep_ms) > 0;
}

}  // namespace

OperatorDialog::OperatorDialog(std::function<bool()> interrupted)
    : interrupted_(std::move(interrupted)),
      terminal_(isatty(STDIN_FILENO) != 0 && isatty(STDERR_FILENO) != 0) {}

void OperatorDialog::require_going_on() const {
  if (interrupted_()) throw Interrupted();
}

void OperatorDialog::say(const std::string& text) const {
  std::fprintf(stderr, "%s\n", text.c_str());
  std::fflush(stderr);
}

std::string OperatorDialog::ask_line(const std::string& question,
                                     const std::function<void()>& meanwhile) const {
  std::fprintf(stderr, "%s ", question.c_str());
  std::fflush(stderr);
  std::string line;
  for (;;) {
    meanwhile();
    require_going_on();
    if (!input_waits()) continue;
    char c = 0;
    if (read(STDIN_FILENO, &c, 1) != 1) throw std::runtime_error("the terminal is gone");
    if (c == '\n' || c == '\r') return line;
    line += c;
  }
}

char OperatorDialog::ask(const std::string& question, const std::string& letters,
                         const std::function<void()>& meanwhile) const {
  for (;;) {
    const std::string line = ask_line(question, meanwhile);
    if (line.size() == 1 && letters.find(line[0]) != std::string::npos) return line[0];
  }
}

}  // namespace swiftlet::ground
