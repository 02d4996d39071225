#include "swiftlet/ground/terminal/fleet_progress.hpp"

#include <algorithm>

namespace swiftlet::ground {
namespace {

constexpr std::size_t kLeastWidth = 16;
constexpr std::size_t kLogWidth = 80;  // of a line that goes to a file

}  // namespace

FleetProgress::FleetProgress(io::ProgressLine& line, const std::vector<std::string>& vehicles) : line_(line) {
  for (const std::string& vehicle : vehicles) shares_.emplace_back(*this, vehicle);
}

void FleetProgress::Share::update(int stage, const std::string& text) {
  const std::lock_guard<std::mutex> lock(all_.mutex_);
  text_ = text;
  const bool is_alone = all_.shares_.size() == 1;
  if (!is_alone) {
    const auto end =
        std::unique(text_.begin(), text_.end(), [](char a, char b) { return a == ' ' && b == ' '; });
    text_.erase(end, text_.end());
  }
  stage_ = stage;
  const std::size_t width = all_.line_.width() > 0 ? all_.line_.width() : kLogWidth;
  std::string line;
  int stages = 0;
  if (all_.shares_.size() > width / kLeastWidth) return all_.show_last(width);
  for (const Share& share : all_.shares_) {
    std::string part = share.vehicle_ + (share.text_.find(' ') == 0 ? "" : " ") + share.text_;
    if (!is_alone || all_.line_.width() > 0) part.resize(width / all_.shares_.size() - 2, ' ');
    line += (line.empty() ? "" : "  ") + part;
    stages += share.stage_;
  }
  all_.line_.update(stages, line);
}

// For more vehicles than fit into the line: the one that is furthest behind.
void FleetProgress::show_last(std::size_t width) {
  int stages = 0;
  for (const Share& share : shares_) stages += share.stage_;
  const Share& last = *std::min_element(shares_.begin(), shares_.end(),
                                        [](const Share& a, const Share& b) { return a.stage_ < b.stage_; });
  const std::string text =
      "last of " + std::to_string(shares_.size()) + ": " + last.vehicle_ + " " + last.text_;
  line_.update(stages, text.substr(0, width));
}

void FleetProgress::Share::say(const std::string& text) {
  const std::lock_guard<std::mutex> lock(all_.mutex_);
  all_.line_.say(vehicle_ + ": " + text);
}

}  // namespace swiftlet::ground
