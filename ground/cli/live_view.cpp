#include "swiftlet/ground/cli/live_view.hpp"

#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>

#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/io/command_line/installation.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

constexpr auto kStartTimeout = 20s;
constexpr auto kStopTimeout = 2s;
constexpr auto kPoll = 20ms;

io::ProcessSettings settings_of(const dds::NodeSettings& network, const std::vector<std::string>& vehicles,
                                const std::filesystem::path& folder) {
  io::ProcessSettings settings;
  settings.name = "swiftlet-view";
  settings.program = io::program_beside(settings.name);
  settings.arguments = network_arguments(network);
  settings.arguments.insert(settings.arguments.begin(), "view");
  settings.arguments.insert(settings.arguments.end(),
                            {"--any-port", "--vehicle-name", fmt::format("{}", fmt::join(vehicles, ","))});
  settings.log_file = folder / "swiftlet-view.log";
  return settings;
}

// Its first whole line that is a URL; "" while there is none.
std::string url_in(const std::filesystem::path& log) {
  std::ifstream lines(log);
  for (std::string line; std::getline(lines, line) && !lines.eof();) {
    if (line.rfind("http://", 0) == 0) return line;
  }
  return "";
}

}  // namespace

LiveView::LiveView(const dds::NodeSettings& network, const std::vector<std::string>& vehicles,
                   const std::filesystem::path& folder)
    : process_(settings_of(network, vehicles, folder)) {
  const auto end = std::chrono::steady_clock::now() + kStartTimeout;
  while ((url_ = url_in(folder / "swiftlet-view.log")).empty()) {
    if (process_.poll() || std::chrono::steady_clock::now() > end)
      throw std::runtime_error("--view: " + process_.last_log_line());
    std::this_thread::sleep_for(kPoll);
  }
}

LiveView::~LiveView() { process_.stop(kStopTimeout); }

}  // namespace swiftlet::ground
