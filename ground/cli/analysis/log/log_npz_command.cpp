#include <memory>

#include <fmt/core.h>

#include "swiftlet/analysis/logs/log_table.hpp"
#include "swiftlet/analysis/logs/npz_writer.hpp"
#include "swiftlet/ground/cli/analysis/log/log_commands.hpp"
#include "swiftlet/record/mcap/signal_arrays.hpp"

namespace swiftlet::ground {
namespace {

struct LogNpzOptions {
  std::string file;
  std::vector<std::string> topics;
  std::string output;
  bool replace = false;
  TimeRange range;
};

template <class Value>
void add_array(analysis::NpzWriter& npz, const std::string& name, const mcap::SignalArray& array,
               const std::vector<std::vector<mcap::Value>>& rows) {
  std::vector<Value> values;
  values.reserve(rows.size() * array.count);
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < array.count; ++i) values.push_back(std::get<Value>(row[array.first + i]));
  }
  if constexpr (std::is_same_v<Value, std::string>) {
    npz.add(name, values);
  } else {
    npz.add(name, values, array.count);
  }
}

void add_topic(analysis::NpzWriter& npz, const mcap::Reader& file, const mcap::Selection& selection,
               const std::string& topic) {
  std::vector<std::int64_t> log_times;
  std::vector<std::vector<mcap::Value>> rows;
  analysis::for_each_row(file, selection, topic, [&](const mcap::Message& message, const auto& values) {
    log_times.push_back(message.log_time_ns);
    rows.push_back(values);
  });
  if (rows.empty()) return;
  const std::string prefix = topic.substr(topic.find_first_not_of('/')) + "/";
  npz.add(prefix + "log_time_ns", log_times, 1);
  for (const mcap::SignalArray& array : mcap::signal_arrays(analysis::columns_of(file, topic))) {
    const std::string name = prefix + array.name;
    switch (array.kind) {
      case mcap::Column::Kind::kFloat:
        add_array<double>(npz, name, array, rows);
        break;
      case mcap::Column::Kind::kSigned:
        add_array<std::int64_t>(npz, name, array, rows);
        break;
      case mcap::Column::Kind::kUnsigned:
        add_array<std::uint64_t>(npz, name, array, rows);
        break;
      case mcap::Column::Kind::kText:
        add_array<std::string>(npz, name, array, rows);
        break;
    }
  }
}

int npz(const LogNpzOptions& options) {
  require_new(options.output, options.replace, {options.file});
  const mcap::Reader file(options.file);
  analysis::NpzWriter npz;
  const std::vector<std::string> topics = options.topics.empty() ? decodable_topics(file) : options.topics;
  for (const std::string& topic : topics) add_topic(npz, file, selection_of(options.range, file), topic);
  npz.write(options.output);
  return io::kDone;
}

}  // namespace

io::Command add_log_npz_command(runtime::CommandLine log) {
  const auto options = std::make_shared<LogNpzOptions>();
  const runtime::CommandLine app = log.add_subcommand("npz", "Write topics as arrays for NumPy");
  app.add_option("file", options->file, "MCAP file").type_name("FILE").required();
  app.add_option("-o,--output", options->output, "the file to write").type_name("FILE").required();
  app.add_flag("--replace", options->replace, "overwrite the file");
  app.add_option("--topic", options->topics, "only this topic; may be repeated").repeated();
  add_time_range_options(app, options->range);
  app.footer(
      "The arrays are called kl1/estimate/position_ned and so on, with a row for each message and a column "
      "for "
      "each element; kl1/estimate/log_time_ns holds the times.\n\nexample: swiftlet log npz flight.mcap "
      "--topic "
      "/kl1/estimate -o estimate.npz");
  return {app, [options] { return npz(*options); }};
}

}  // namespace swiftlet::ground
