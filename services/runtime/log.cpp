#include "swiftlet/services/runtime/log.hpp"

#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/async.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "swiftlet/services/runtime/log_label.hpp"

namespace swiftlet::runtime {
namespace {

constexpr std::size_t kQueuedLines = 1024;
constexpr const char* kPattern = "%H:%M:%S.%e %n %^%l%$: %v";  // "05:12:03.123 control warning: ..."

// Adds the label of the calling thread: the asynchronous logger below writes in another thread.
class LabellingLogger final : public spdlog::logger {
 public:
  explicit LabellingLogger(std::shared_ptr<spdlog::logger> below)
      : logger(below->name()), below_(std::move(below)) {
    set_level(below_->level());
  }

 private:
  void sink_it_(const spdlog::details::log_msg& line) override {
    const std::string label = LogLabel::current();
    if (label.empty()) return below_->log(line.source, line.level, line.payload);
    below_->log(line.source, line.level,
                label + ": " + std::string(line.payload.data(), line.payload.size()));
  }
  void flush_() override { below_->flush(); }

  std::shared_ptr<spdlog::logger> below_;
};

spdlog::level::level_enum level_of(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      break;
  }
  return spdlog::level::err;
}

}  // namespace

void write_log(LogLevel level, fmt::string_view format, fmt::format_args arguments) {
  spdlog::logger& logger = *spdlog::default_logger_raw();
  if (!logger.should_log(level_of(level))) return;
  fmt::memory_buffer line;  // on the stack up to 500 bytes
  try {
    fmt::vformat_to(fmt::appender(line), format, arguments);
    logger.log(level_of(level), spdlog::string_view_t(line.data(), line.size()));
  } catch (const std::exception& error) {  // a line that cannot be written ends no flight
    logger.log(spdlog::level::err, std::string("cannot write a log line: ") + error.what());
  }
}

void log_to_stderr(const std::string& program) {
  const auto logger =
      std::make_shared<spdlog::logger>(program, std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  logger->set_pattern(kPattern);
  spdlog::set_default_logger(logger);
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
  logger->set_pattern(kPattern);
  spdlog::set_default_logger(std::make_shared<LabellingLogger>(logger));
}

Logging::~Logging() { spdlog::shutdown(); }

}  // namespace swiftlet::runtime
