#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/analysis/logs/log_diff.hpp"
#include "swiftlet/ground/cli/analysis/log/log_commands.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::ground {
namespace {

struct LogDiffOptions {
  std::string a;
  std::string b;
  std::vector<std::string> topics;
  bool json = false;
};

nlohmann::ordered_json to_json(const LogDiffOptions& options,
                               const std::vector<analysis::TopicDifference>& differences) {
  nlohmann::ordered_json json = {{"a", options.a}, {"b", options.b}};
  json["equal"] = std::all_of(differences.begin(), differences.end(),
                              [](const analysis::TopicDifference& topic) { return topic.equal; });
  json["topics"] = nlohmann::ordered_json::array();
  for (const analysis::TopicDifference& topic : differences) {
    nlohmann::ordered_json row = {
        {"topic", topic.topic},           {"messages_a", topic.messages_a},
        {"messages_b", topic.messages_b}, {"equal", topic.equal},
        {"compared", topic.compared},     {"signals", nlohmann::ordered_json::object()}};
    for (const analysis::SignalDifference& signal : topic.signals)
      row["signals"][signal.name] = {{"rms", signal.rms}, {"max", signal.max}, {"max_at_s", signal.max_at_s}};
    json["topics"].push_back(row);
  }
  return json;
}

void print(const std::vector<analysis::TopicDifference>& differences) {
  std::size_t width = 5;
  for (const analysis::TopicDifference& topic : differences) {
    width = std::max(width, topic.topic.size());
    for (const analysis::SignalDifference& signal : topic.signals)
      width = std::max(width, signal.name.size() + 2);
  }
  fmt::print("{:<{}} {:>10} {:>10} {:>11} {:>11} {:>9}\n", "topic", width, "messages A", "B", "RMS B - A",
             "max", "at, s");
  for (const analysis::TopicDifference& topic : differences) {
    const bool alike = topic.compared > 0 && std::all_of(topic.signals.begin(), topic.signals.end(),
                                                         [](const analysis::SignalDifference& signal) {
                                                           return signal.max == 0.0;
                                                         });
    fmt::print("{:<{}} {:>10} {:>10}{}\n", topic.topic, width, topic.messages_a, topic.messages_b,
               topic.equal ? "       equal"
               : alike     ? "  no difference"
                           : "");
    for (const analysis::SignalDifference& signal : topic.signals) {
      if (signal.max == 0.0) continue;
      fmt::print("  {:<{}} {:>33.4g} {:>11.4g} {:>9.3f}\n", signal.name, width - 2, signal.rms, signal.max,
                 signal.max_at_s);
    }
  }
}

int diff(const LogDiffOptions& options) {
  const mcap::Reader a(options.a);
  const mcap::Reader b(options.b);
  const std::vector<analysis::TopicDifference> differences =
      analysis::difference(a, b, {options.topics.begin(), options.topics.end()});
  if (options.json) {
    std::printf("%s\n", io::json_text(to_json(options, differences), 2).c_str());
  } else {
    print(differences);
  }
  return io::kDone;
}

}  // namespace

io::Command add_log_diff_command(runtime::CommandLine log) {
  const auto options = std::make_shared<LogDiffOptions>();
  const runtime::CommandLine app =
      log.add_subcommand("diff", "Compare two recorded flights by topic, in figures");
  app.add_option("a", options->a, "MCAP file").type_name("A").required();
  app.add_option("b", options->b, "MCAP file").type_name("B").required();
  app.add_option("--topic", options->topics, "only this topic; may be repeated").repeated();
  app.add_flag("--json", options->json, "print JSON, also the signals without a difference");
  app.footer(
      "Times count from the start of the mission in each file, so that flights begun at other times are "
      "compared, too; without a\nmission from the first message. B is interpolated at the times of A. RMS "
      "and largest difference are lengths of vectors, and\nangles in rad between attitudes. `equal`: the "
      "same messages, byte for byte, as in two lockstep flights of one seed.\n\n"
      "example: swiftlet log diff monday/flight.mcap tuesday/flight.mcap --topic /kl1/ground_truth");
  return {app, [options] { return diff(*options); }};
}

}  // namespace swiftlet::ground
