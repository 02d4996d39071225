#include "swiftlet/io/command_line/progress_line.hpp"

#include <cstdio>
#include <sys/ioctl.h>
#include <unistd.h>

namespace swiftlet::io {
namespace {

constexpr std::chrono::milliseconds kTerminalPeriod{100};
constexpr std::chrono::seconds kLinePeriod{10};
constexpr const char* kClearLine = "\r\x1b[K";

}  // namespace

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) != 0) {}

ProgressLine::~ProgressLine() { close(); }

// One column less than the terminal: a wrapped line could not be overwritten.
std::size_t ProgressLine::width() const {
  winsize size{};
  if (!terminal_ || ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 0;
  return size.ws_col - 1U;
}

void ProgressLine::close() {
  if (line_open_) std::fputc('\n', stderr);
  line_open_ = false;
}

void ProgressLine::update(int stage, const std::string& text) {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_ && stage == stage_) return;
  stage_ = stage;
  if (terminal_) {
    next_ = now + kTerminalPeriod;
    std::fprintf(stderr, "%s%s", kClearLine, (width() > 0 ? text.substr(0, width()) : text).c_str());
    std::fflush(stderr);
    line_open_ = true;
  } else {
    next_ = now + kLinePeriod;
    std::fprintf(stderr, "%s\n", text.c_str());
  }
}

void ProgressLine::say(const std::string& text) {
  std::fprintf(stderr, "%s%s\n", line_open_ ? kClearLine : "", text.c_str());
  line_open_ = false;
}

}  // namespace swiftlet::io
