// The progress of several vehicles that fly at the same time, on one line of a terminal, or of 80 columns.
#pragma once

#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "swiftlet/io/command_line/progress.hpp"
#include "swiftlet/io/command_line/progress_line.hpp"

namespace swiftlet::ground {

class FleetProgress {
 public:
  FleetProgress(io::ProgressLine& line, const std::vector<std::string>& vehicles);
  FleetProgress(const FleetProgress&) = delete;
  FleetProgress& operator=(const FleetProgress&) = delete;

  // The progress of one vehicle, by its index. Each vehicle may report from its own thread.
  io::Progress& of(std::size_t vehicle) { return shares_[vehicle]; }

 private:
  class Share final : public io::Progress {
   public:
    Share(FleetProgress& all, std::string vehicle) : all_(all), vehicle_(std::move(vehicle)) {}
    void update(int stage, const std::string& text) override;
    void say(const std::string& text) override;

   private:
    friend class FleetProgress;
    FleetProgress& all_;
    std::string vehicle_;
    std::string text_;
    int stage_ = 0;
  };

  void show_last(std::size_t width);  // requires mutex_

  io::ProgressLine& line_;
  std::mutex mutex_;  // guards line_ and shares_
  std::deque<Share> shares_;
};

}  // namespace swiftlet::ground
