#include <memory>

#include "swiftlet/ground/cli/analysis/log/log_commands.hpp"
#include "swiftlet/ground/recording/log_table.hpp"
#include "swiftlet/io/csv_writer.hpp"

namespace swiftlet::ground {
namespace {

struct LogCsvOptions {
  std::string file;
  std::string topic;
  std::string output;
  bool replace = false;
  TimeRange range;
};

void add_cell(runtime::CsvWriter& csv, const mcap::Value& value) {
  if (const auto* const number = std::get_if<double>(&value)) {
    csv.exact(*number);
  } else if (const auto* const text = std::get_if<std::string>(&value)) {
    csv.text(*text);
  } else if (const auto* const integer = std::get_if<std::int64_t>(&value)) {
    csv.text(std::to_string(*integer));
  } else {
    csv.text(std::to_string(std::get<std::uint64_t>(value)));
  }
}

int csv(const LogCsvOptions& options) {
  require_new(options.output, options.replace, {options.file});
  const mcap::Reader file(options.file);
  std::vector<std::string> names = {"log_time_ns", "publish_time_ns"};
  for (const mcap::Column& column : columns_of(file, options.topic)) names.push_back(column.name);
  runtime::CsvWriter csv(options.output, names);
  for_each_row(file, selection_of(options.range, file), options.topic,
               [&](const mcap::Message& message, const std::vector<mcap::Value>& values) {
                 csv.text(std::to_string(message.log_time_ns)).text(std::to_string(message.publish_time_ns));
                 for (const mcap::Value& value : values) add_cell(csv, value);
                 csv.end_row();
               });
  csv.finish();
  return kDone;
}

}  // namespace

Command add_log_csv_command(runtime::CommandLine log) {
  const auto options = std::make_shared<LogCsvOptions>();
  const runtime::CommandLine app =
      log.add_subcommand("csv", "Write the messages of a topic as a CSV table, one row each");
  app.add_option("file", options->file, "MCAP file").type_name("FILE").required();
  app.add_option("topic", options->topic, "the topic").type_name("TOPIC").required();
  app.add_option("-o,--output", options->output, "the file to write").type_name("FILE").required();
  app.add_flag("--replace", options->replace, "overwrite the file");
  add_time_range_options(app, options->range);
  app.footer(
      "Numbers have the shortest form that reads back as the same value. Of a sequence only its length is "
      "written.\n\nexample: swiftlet log csv flight.mcap /kl1/estimate -o estimate.csv");
  return {app, [options] { return csv(*options); }};
}

}  // namespace swiftlet::ground
