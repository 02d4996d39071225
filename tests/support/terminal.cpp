#include "tests/support/terminal.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <system_error>
#include <termios.h>
#include <thread>
#include <unistd.h>
#include <utmp.h>

#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::tests {
namespace {

// As much of an xterm as a full-screen program in plain ASCII needs: ECMA-48 control sequences that move the
// cursor, erase, insert and delete, and those that are without effect on the text.
class Screen {
 public:
  Screen(int width, int height) { resize(width, height); }

  void resize(int width, int height) {
    width_ = width;
    height_ = height;
    lines_.assign(static_cast<std::size_t>(height), std::string(static_cast<std::size_t>(width), ' '));
    column_ = row_ = 0;
    top_ = 0;
    bottom_ = height - 1;
  }
  std::string line(int row) const {
    const std::string& text = lines_.at(static_cast<std::size_t>(row));
    return text.substr(0, text.find_last_not_of(' ') + 1);
  }
  int height() const { return height_; }
  bool alternate() const { return alternate_; }

  void take(char c) {
    if (!sequence_.empty()) return in_sequence(c);
    if (c == '\x1b') {
      sequence_ = c;
    } else if (c == '\r') {
      column_ = 0;
    } else if (c == '\n') {
      feed();
    } else if (c == '\b') {
      column_ = std::max(column_ - 1, 0);
    } else if (c == '\t') {
      column_ = std::min((column_ / 8 + 1) * 8, width_ - 1);
    } else if (c >= ' ') {
      put(c);
    }
  }

 private:
  std::string& here() { return lines_[static_cast<std::size_t>(row_)]; }
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  void put(char c) {
    if (column_ == width_) {
      column_ = 0;
      feed();
    }
    here()[index(column_++)] = last_ = c;
  }
  void feed() {
    if (row_ == bottom_) {
      scroll(top_, 1);
    } else {
      row_ = std::min(row_ + 1, height_ - 1);
    }
  }
  // Lines from `first` to the bottom margin move up, or down by less than 0.
  void scroll(int first, int by) {
    for (; by > 0; --by) {
      lines_.erase(lines_.begin() + first);
      lines_.insert(lines_.begin() + bottom_, blank());
    }
    for (; by < 0; ++by) {
      lines_.erase(lines_.begin() + bottom_);
      lines_.insert(lines_.begin() + first, blank());
    }
  }
  std::string blank() const { return std::string(index(width_), ' '); }

  void in_sequence(char c) {
    sequence_ += c;
    if (sequence_.size() == 2) {
      if (c == '[' || c == '(' || c == ')' || c == ']') return;
      if (c == 'M') row_ == top_ ? scroll(top_, -1) : void(row_ = std::max(row_ - 1, 0));
      sequence_.clear();
      return;
    }
    const char kind = sequence_[1];
    const bool over = kind == '[' ? c >= '@' && c <= '~' : kind == ']' ? c == '\a' : true;
    if (!over) return;
    if (kind == '[') control(c);
    sequence_.clear();
  }

  int number(std::size_t place, int otherwise) const {
    std::size_t at = 2;
    for (; place > 0 && at != std::string::npos; --place) {
      at = sequence_.find(';', at);
      if (at != std::string::npos) ++at;
    }
    if (at == std::string::npos) return otherwise;
    const int value = std::atoi(sequence_.c_str() + at);
    return value == 0 ? otherwise : value;
  }

  // Returns false for another sequence.
  bool move_cursor(char c, int n) {
    switch (c) {
      case 'A':
        row_ = std::max(row_ - n, 0);
        return true;
      case 'B':
        row_ = std::min(row_ + n, height_ - 1);
        return true;
      case 'C':
        column_ = std::min(column_ + n, width_ - 1);
        return true;
      case 'D':
        column_ = std::max(column_ - n, 0);
        return true;
      case 'G':
        column_ = std::min(n, width_) - 1;
        return true;
      case 'd':
        row_ = std::min(n, height_) - 1;
        return true;
      case 'H':
        row_ = std::min(n, height_) - 1;
        column_ = std::min(number(1, 1), width_) - 1;
        return true;
      default:
        return false;
    }
  }

  void control(char c) {
    const int n = number(0, 1);
    if (move_cursor(c, n)) return;
    switch (c) {
      case 'J':
        erase_display();
        break;
      case 'K':
        erase_line();
        break;
      case 'X':
        here().replace(index(column_), index(std::min(n, width_ - column_)),
                       index(std::min(n, width_ - column_)), ' ');
        break;
      case '@':
        here().insert(index(column_), index(n), ' ');
        here().resize(index(width_));
        break;
      case 'P':
        here().erase(index(column_), index(n));
        here().resize(index(width_), ' ');
        break;
      case 'L':
        scroll(row_, -n);
        break;
      case 'M':
        scroll(row_, n);
        break;
      case 'S':
        scroll(top_, n);
        break;
      case 'T':
        scroll(top_, -n);
        break;
      case 'b':
        for (int i = 0; i < n; ++i) put(last_);
        break;
      case 'r':
        top_ = n - 1;
        bottom_ = std::min(number(1, height_), height_) - 1;
        row_ = column_ = 0;
        break;
      case 'h':
      case 'l':
        if (sequence_.find("?1049") != std::string::npos) alternate_ = c == 'h';
        break;
      default:
        break;  // colours and invisible sequences
    }
  }
  void erase_line() {
    const int what = number(0, 0);
    const int first = what == 0 ? column_ : 0;
    const int last = what == 1 ? column_ + 1 : width_;
    here().replace(index(first), index(last - first), index(last - first), ' ');
  }
  void erase_display() {
    const int what = number(0, 0);
    if (what != 2) erase_line();
    for (int row = what == 0 ? row_ + 1 : 0; row < (what == 1 ? row_ : height_); ++row)
      lines_[index(row)] = blank();
  }

  int width_ = 0, height_ = 0, column_ = 0, row_ = 0, top_ = 0, bottom_ = 0;
  char last_ = ' ';
  bool alternate_ = false;
  std::vector<std::string> lines_;
  std::string sequence_;
};

bool same(const termios& a, const termios& b) {
  return a.c_iflag == b.c_iflag && a.c_oflag == b.c_oflag && a.c_lflag == b.c_lflag;
}

}  // namespace

struct Terminal::Impl {
  Impl(int width, int height) : screen(width, height) {}

  void read_on() {
    char bytes[4096];
    pollfd ready{master, POLLIN, 0};
    while (!ends) {
      if (poll(&ready, 1, 20) <= 0) continue;
      const ssize_t count = read(master, bytes, sizeof bytes);
      if (count <= 0) return;  // the program has ended
      const std::lock_guard lock(mutex);
      for (ssize_t i = 0; i < count; ++i) screen.take(bytes[i]);
    }
  }

  int master = -1;
  int slave = -1;  // kept open to read its modes after the program ends
  pid_t pid = -1;
  bool reaped = false;
  int status = 0;
  termios before{};
  std::atomic<bool> ends{false};
  std::mutex mutex;  // of the screen
  Screen screen;
  std::thread reader;
};

Terminal::Terminal(const std::string& name, std::vector<std::string> arguments, int width, int height)
    : impl_(std::make_unique<Impl>(width, height)) {
  arguments.insert(arguments.begin(), program_file(name));
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  winsize size{};
  size.ws_col = static_cast<unsigned short>(width);
  size.ws_row = static_cast<unsigned short>(height);
  if (openpty(&impl_->master, &impl_->slave, nullptr, nullptr, &size) != 0)
    throw std::system_error(errno, std::generic_category(), "openpty");
  tcgetattr(impl_->slave, &impl_->before);
  setenv("TERM", "xterm", 1);
  setenv("SWIFTLET_CONFIG_DIR", in_source("config").c_str(), 1);
  impl_->pid = fork();
  if (impl_->pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    close(impl_->master);
    login_tty(impl_->slave);
    execv(words[0], words.data());
    _exit(127);
  }
  if (impl_->pid < 0) throw std::system_error(errno, std::generic_category(), "fork");
  impl_->reader = std::thread([this] { impl_->read_on(); });
}

Terminal::~Terminal() {
  if (!impl_->reaped) {
    kill(impl_->pid, SIGKILL);
    waitpid(impl_->pid, &impl_->status, 0);
  }
  hang_up();
  close(impl_->slave);
}

void Terminal::hang_up() {
  impl_->ends = true;
  if (impl_->reader.joinable()) impl_->reader.join();
  if (impl_->master >= 0) close(impl_->master);
  impl_->master = -1;
}

void Terminal::type(const std::string& keys) {
  if (write(impl_->master, keys.data(), keys.size()) != static_cast<ssize_t>(keys.size()))
    throw std::system_error(errno, std::generic_category(), "write");
}

void Terminal::signal(int number) const { kill(impl_->pid, number); }

void Terminal::resize(int width, int height) {
  winsize size{};
  size.ws_col = static_cast<unsigned short>(width);
  size.ws_row = static_cast<unsigned short>(height);
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->screen.resize(width, height);
  }
  ioctl(impl_->slave, TIOCSWINSZ, &size);
}

std::string Terminal::line(int row) {
  const std::lock_guard lock(impl_->mutex);
  return impl_->screen.line(row);
}

std::string Terminal::text() {
  const std::lock_guard lock(impl_->mutex);
  std::string text;
  for (int row = 0; row < impl_->screen.height(); ++row) text += impl_->screen.line(row) + "\n";
  return text;
}

int Terminal::wait(std::chrono::milliseconds timeout) {
  const bool ended = eventually(
      [this] {
        if (!impl_->reaped) impl_->reaped = waitpid(impl_->pid, &impl_->status, WNOHANG) == impl_->pid;
        return impl_->reaped;
      },
      timeout);
  if (!ended) return -1;
  return WIFSIGNALED(impl_->status) ? 128 + WTERMSIG(impl_->status) : WEXITSTATUS(impl_->status);
}

bool Terminal::is_restored() {
  termios now{};
  tcgetattr(impl_->slave, &now);
  const std::lock_guard lock(impl_->mutex);
  return same(now, impl_->before) && !impl_->screen.alternate();
}

}  // namespace swiftlet::tests
