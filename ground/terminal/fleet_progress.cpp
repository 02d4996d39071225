#include "swiftlet/ground/terminal/fleet_progress.hpp"

#include <algorithm>

namespace swiftlet::ground {
namespace {

constexpr std::size_t kLeastWidth = 16;

}  // namespace

FleetProgress::FleetProgress(ProgressLine& line, const std::vector<std::string>& vehicles) : line_(line) {
  for (const std::string& vehicle : vehicles) shares_.emplace_back(*this, vehicle);
}

void FleetProgress::Share::update(int stage, const std::string& text) {
  const std::lock_guard<std::mutex> lock(all_.mutex_);
  text_ = text;
  stage_ = stage;
  const std::size_t width = all_.line_.width();
  std::string line;
  int stages = 0;
  for (const Share& share : all_.shares_) {
    std::string part = share.vehicle_ + " " + share.text_;
    if (width > 0) part.resize(std::max(kLeastWidth, width / all_.shares_.size()) - 2, ' ');
    line += (line.empty() ? "" : "  ") + part;
    stages += share.stage_;
  }
  all_.line_.update(stages, line);
}

void FleetProgress::Share::say(const std::string& text) {
  const std::lock_guard<std::mutex> lock(all_.mutex_);
  all_.line_.say(vehicle_ + ": " + text);
}

}  // namespace swiftlet::ground
