#include "swiftlet/services/runtime/log.hpp"

#include <memory>
#include <stdexcept>
#include <vector>

#include <spdlog/async.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace swiftlet::runtime {
namespace {

constexpr std::size_t kQueuedLines = 1024;

}  // namespace

void log_to_stderr() {
  spdlog::default_logger()->sinks() = {std::make_shared<spdlog::sinks::stderr_color_sink_mt>()};
}

Logging::Logging(const std::string& process, const LogSettings& settings) {
  std::vector<spdlog::sink_ptr> sinks{std::make_shared<spdlog::sinks::stderr_color_sink_mt>()};
  try {
    if (!settings.file.empty())
      sinks.push_back(std::make_shared<spdlog::sinks::basic_file_sink_mt>(settings.file));
  } catch (const spdlog::spdlog_ex& error) {
    throw std::runtime_error("cannot write log file " + settings.file + ": " + error.what());
  }
  spdlog::init_thread_pool(kQueuedLines, 1);
  const auto logger =
      std::make_shared<spdlog::async_logger>(process, sinks.begin(), sinks.end(), spdlog::thread_pool(),
                                             spdlog::async_overflow_policy::overrun_oldest);
  logger->set_level(spdlog::level::from_str(settings.level));
  logger->flush_on(spdlog::level::info);
  logger->set_pattern("%H:%M:%S.%e %n %^%l%$: %v");
  spdlog::set_default_logger(logger);
}

Logging::~Logging() { spdlog::shutdown(); }

}  // namespace swiftlet::runtime
