#include "swiftlet/ground/terminal/terminal_screen.hpp"

#include <algorithm>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <langinfo.h>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <unistd.h>

#define NCURSES_NOMACROS  // the macro names are common words
#include <ncurses.h>

namespace swiftlet::ground {
namespace {

constexpr short kWarningColours = 1;
constexpr short kGoodColours = 2;

attr_t attributes_of(Emphasis emphasis, bool colours) {
  switch (emphasis) {
    case Emphasis::kHeading:
      return A_BOLD;
    case Emphasis::kGood:
      return colours ? COLOR_PAIR(kGoodColours) : A_NORMAL;
    case Emphasis::kWarning:
      return A_BOLD | (colours ? COLOR_PAIR(kWarningColours) : A_REVERSE);
    case Emphasis::kPlain:
      break;
  }
  return A_NORMAL;
}

// Where the terminal's characters are not UTF-8, '>' marks a text that is cut.
std::string in_this_locale(std::string text) {
  if (std::strcmp(nl_langinfo(CODESET), "UTF-8") == 0) return text;
  if (const std::size_t cut = text.find(kCut); cut != std::string::npos)
    text.replace(cut, std::strlen(kCut), ">");
  return text;
}

}  // namespace

struct TerminalScreen::Impl {
  SCREEN* screen = nullptr;
  bool colours = false;
};

TerminalScreen::TerminalScreen(const std::string& instead) : impl_(new Impl) {
  std::setlocale(LC_CTYPE, "");
  impl_->screen = newterm(nullptr, stdout, stdin);
  if (impl_->screen == nullptr) {
    delete impl_;
    const char* const kind = std::getenv("TERM");
    throw std::runtime_error(std::string("terminal type '") + (kind != nullptr ? kind : "") +
                             "' does not support full screen; " + instead);
  }
  set_term(impl_->screen);
  cbreak();
  noqiflush();  // Ctrl-C would discard a key that key() has seen, and key() would then wait for the next one
  noecho();
  keypad(stdscr, TRUE);
  set_escdelay(25);
  curs_set(0);
  impl_->colours = has_colors();
  if (!impl_->colours) return;
  start_color();
  use_default_colors();
  init_pair(kWarningColours, COLOR_RED, -1);
  init_pair(kGoodColours, COLOR_GREEN, -1);
}

TerminalScreen::~TerminalScreen() {
  endwin();
  delscreen(impl_->screen);
  delete impl_;
}

int TerminalScreen::width() const { return getmaxx(stdscr); }
int TerminalScreen::height() const { return getmaxy(stdscr); }

void TerminalScreen::show(const std::vector<ScreenLine>& lines) {
  werase(stdscr);
  const auto draw = [this](std::size_t row, int column, const std::string& text, Emphasis emphasis) {
    const attr_t attributes = attributes_of(emphasis, impl_->colours);
    wattron(stdscr, static_cast<int>(attributes));
    const std::string shown = cut_to(text, static_cast<std::size_t>(std::max(width() - column, 0)));
    mvwaddstr(stdscr, static_cast<int>(row), column, in_this_locale(shown).c_str());
    wattroff(stdscr, static_cast<int>(attributes));
  };
  for (std::size_t row = 0; row < lines.size(); ++row) {
    draw(row, 0, lines[row].text, lines[row].emphasis);
    if (!lines[row].right_text.empty())
      draw(row, kRightColumn, lines[row].right_text, lines[row].right_emphasis);
  }
  wrefresh(stdscr);
}

std::optional<int> TerminalScreen::key(int within_ms) {
  wtimeout(stdscr, within_ms);
  const int key = wgetch(stdscr);
  switch (key) {
    case ERR:
      return std::nullopt;
    case KEY_RESIZE:
      return kResized;
    case KEY_UP:
      return kUpArrow;
    case KEY_DOWN:
      return kDownArrow;
    case KEY_LEFT:
      return kLeftArrow;
    case KEY_RIGHT:
      return kRightArrow;
    default:
      return key;
  }
}

bool TerminalScreen::is_open() const {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  return poll(&input, 1, 0) <= 0 || (input.revents & (POLLHUP | POLLERR | POLLNVAL)) == 0;
}

}  // namespace swiftlet::ground
