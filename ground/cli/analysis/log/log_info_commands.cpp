#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>
#include <memory>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/analysis/logs/log_table.hpp"
#include "swiftlet/ground/cli/analysis/log/log_commands.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/record/mcap/reader.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kNs = 1e-9;
constexpr std::size_t kLongestValue = 60;

struct LogInfoOptions {
  std::string file;
  std::string topic;
  bool check = false;
  bool json = false;
};

struct TopicRow {
  std::string type;
  std::uint64_t messages = 0;
};

double duration_s(const mcap::Reader& file) {
  return static_cast<double>(file.statistics().end_ns - file.statistics().start_ns) * kNs;
}

std::map<std::string, TopicRow> topics_of(const mcap::Reader& file) {
  std::map<std::string, TopicRow> rows;
  for (const auto& [id, channel] : file.channels()) {
    TopicRow& row = rows[channel.topic];
    const mcap::Schema* const schema = file.schema_of(channel);
    if (schema != nullptr) row.type = schema->name;
    const auto& counts = file.statistics().messages_by_channel;
    const auto count = counts.find(id);
    if (count != counts.end()) row.messages += count->second;
  }
  return rows;
}

double rate_hz(const TopicRow& row, double time_s) {
  return time_s > 0.0 ? static_cast<double>(row.messages) / time_s : 0.0;
}

// "2026-11-25 09:40:12.123 UTC", or "12.300 s" of simulated time.
std::string time_text(std::int64_t ns) {
  constexpr std::int64_t kYear2000_ns = 946'684'800'000'000'000;
  if (ns < kYear2000_ns) return fmt::format("{:.3f} s", static_cast<double>(ns) * kNs);
  const std::time_t seconds = static_cast<std::time_t>(ns / 1'000'000'000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char text[32] = {};
  std::strftime(text, sizeof(text), "%Y-%m-%d %H:%M:%S", &utc);
  return fmt::format("{}.{:03} UTC", text, ns / 1'000'000 % 1000);
}

nlohmann::ordered_json to_json(const mcap::Reader& file) {
  const mcap::Statistics& statistics = file.statistics();
  nlohmann::ordered_json json = {{"file", file.name()},
                                 {"bytes", file.file_bytes()},
                                 {"profile", file.header().profile},
                                 {"library", file.header().library},
                                 {"finished", file.finished()},
                                 {"messages", statistics.message_count},
                                 {"chunks", statistics.chunk_count},
                                 {"start_ns", statistics.start_ns},
                                 {"end_ns", statistics.end_ns},
                                 {"duration_s", duration_s(file)}};
  json["topics"] = nlohmann::ordered_json::array();
  for (const auto& [topic, row] : topics_of(file))
    json["topics"].push_back({{"topic", topic},
                              {"type", row.type},
                              {"messages", row.messages},
                              {"rate_hz", rate_hz(row, duration_s(file))}});
  json["metadata"] = nlohmann::ordered_json::object();
  for (const mcap::Metadata& metadata : file.metadata()) json["metadata"][metadata.name] = metadata.values;
  json["attachments"] = nlohmann::ordered_json::array();
  for (const mcap::AttachmentIndex& attachment : file.attachments())
    json["attachments"].push_back(
        {{"name", attachment.name}, {"media_type", attachment.media_type}, {"bytes", attachment.data_size}});
  json["damages"] = nlohmann::ordered_json::array();
  for (const mcap::Damage& damage : file.damages())
    json["damages"].push_back({{"byte", damage.offset}, {"what", damage.what}});
  return json;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.size() > kLongestValue ? text.substr(0, kLongestValue) + "..." : text;
}

void print(const mcap::Reader& file) {
  const mcap::Statistics& statistics = file.statistics();
  std::uint64_t unpacked = 0;
  for (const mcap::ChunkIndex& chunk : file.chunks()) unpacked += chunk.uncompressed_size;
  fmt::print("{}: {} messages of {} topics, {:.1f} s, {:.1f} MB ({:.1f} MB unpacked){}\n", file.name(),
             statistics.message_count, statistics.messages_by_channel.size(), duration_s(file),
             static_cast<double>(file.file_bytes()) / 1e6, static_cast<double>(unpacked) / 1e6,
             file.finished() ? "" : "; not finished: its writer was ended");
  if (statistics.message_count > 0)
    fmt::print("  from {} to {}\n", time_text(statistics.start_ns), time_text(statistics.end_ns));
  fmt::print("  profile {}, written by {}\n", file.header().profile, file.header().library);
  for (const mcap::Metadata& metadata : file.metadata()) {
    fmt::print("  {}\n", metadata.name);
    for (const auto& [key, value] : metadata.values) fmt::print("    {:<24} {}\n", key, one_line(value));
  }
  for (const mcap::AttachmentIndex& attachment : file.attachments())
    fmt::print("  attachment {} ({} bytes)\n", attachment.name, attachment.data_size);
  for (const mcap::Damage& damage : file.damages())
    fmt::print("  damaged: byte {}: {}\n", damage.offset, damage.what);
}

int info(const LogInfoOptions& options) {
  const mcap::Reader file(options.file, options.check ? mcap::Access::kScanned : mcap::Access::kIndexed);
  if (options.json) {
    std::printf("%s\n", io::json_text(to_json(file), 2).c_str());
  } else {
    print(file);
  }
  return file.damages().empty() ? io::kDone : io::kFailed;
}

int list_signals(const mcap::Reader& file, const LogInfoOptions& options) {
  const std::vector<mcap::Column> columns = analysis::columns_of(file, options.topic);
  if (options.json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const mcap::Column& column : columns) json.push_back(column.name);
    std::printf("%s\n", io::json_text(json, 2).c_str());
    return io::kDone;
  }
  for (const mcap::Column& column : columns) std::printf("%s\n", column.name.c_str());
  return io::kDone;
}

int ls(const LogInfoOptions& options) {
  const mcap::Reader file(options.file);
  if (!options.topic.empty()) return list_signals(file, options);
  const auto rows = topics_of(file);
  if (options.json) {
    std::printf("%s\n", io::json_text(to_json(file).at("topics"), 2).c_str());
    return io::kDone;
  }
  std::size_t width = 5;
  for (const auto& [topic, row] : rows) width = std::max(width, topic.size());
  fmt::print("{:<{}} {:>10} {:>10}  {}\n", "topic", width, "messages", "rate", "type");
  for (const auto& [topic, row] : rows) {
    if (row.messages == 0) continue;
    fmt::print("{:<{}} {:>10} {:>7.1f} Hz  {}\n", topic, width, row.messages, rate_hz(row, duration_s(file)),
               row.type);
  }
  return io::kDone;
}

}  // namespace

io::Command add_log_info_command(runtime::CommandLine log) {
  const auto options = std::make_shared<LogInfoOptions>();
  const runtime::CommandLine app =
      log.add_subcommand("info", "Show times, counts, metadata and attachments of a recorded file");
  app.add_option("file", options->file, "MCAP file").type_name("FILE").required();
  app.add_flag("--check", options->check,
               "read the whole file and check every CRC; exit code 1 if it is damaged");
  app.add_flag("--json", options->json, "print the result as JSON");
  app.footer("example: swiftlet log info flight.mcap --check");
  return {app, [options] { return info(*options); }};
}

io::Command add_log_ls_command(runtime::CommandLine log) {
  const auto options = std::make_shared<LogInfoOptions>();
  const runtime::CommandLine app =
      log.add_subcommand("ls", "List the topics of a recorded file, or the signals of one");
  app.add_option("file", options->file, "MCAP file").type_name("FILE").required();
  app.add_option("topic", options->topic, "list the signals of this topic").type_name("TOPIC");
  app.add_flag("--json", options->json, "print the list as JSON");
  app.footer("example: swiftlet log ls flight.mcap /kl1/estimate");
  return {app, [options] { return ls(*options); }};
}

}  // namespace swiftlet::ground
