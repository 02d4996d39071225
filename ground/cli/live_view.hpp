// The live page of `swiftlet view` beside a flight, served by a process of its own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "swiftlet/io/command_line/child_process.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

class LiveView {
 public:
  // Starts swiftlet-view, and waits until it serves. folder: for its log. Another port than the usual one if that is in use. Throws
  // std::runtime_error with the last line of its log if it cannot serve.
  LiveView(const dds::NodeSettings& network, const std::vector<std::string>& vehicles,
           const std::filesystem::path& folder);
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  const std::string& url() const { return url_; }

 private:
  io::ChildProcess process_;
  std::string url_;
};

}  // namespace swiftlet::ground
