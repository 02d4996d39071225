#include <memory>

#include "swiftlet/analysis/logs/flight_csv.hpp"
#include "swiftlet/analysis/logs/log_table.hpp"
#include "swiftlet/ground/cli/analysis/log/log_commands.hpp"
#include "swiftlet/io/csv_writer.hpp"
#include "swiftlet/record/file/flight_reader.hpp"

namespace swiftlet::ground {
namespace {

struct LogCsvOptions {
  std::string file;
  std::string topic;    // empty: the flight
  std::string vehicle;  // of the flight; empty: the only one
  std::string output;
  bool replace = false;
  TimeRange range;
};

void add_cell(io::CsvWriter& csv, const mcap::Value& value) {
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
  const record::FlightFile from = record::flight_file(options.file);
  const std::string name = from.file.string();
  require_new(options.output, options.replace, {name});
  const mcap::Reader file(name);
  if (options.topic.empty()) {
    if (options.range.is_given())
      throw io::InputError("--from, --to: are of the messages of a topic; name a TOPIC");
    analysis::write_flight_csv(
        options.output,
        record::read_flight(
            file, record::recorded_vehicle(file, options.vehicle.empty() ? from.vehicle : options.vehicle)));
    return io::kDone;
  }
  std::vector<std::string> names = {"log_time_ns", "publish_time_ns"};
  for (const mcap::Column& column : analysis::columns_of(file, options.topic)) names.push_back(column.name);
  io::CsvWriter csv(options.output, names);
  analysis::for_each_row(
      file, selection_of(options.range, file), options.topic,
      [&](const mcap::Message& message, const std::vector<mcap::Value>& values) {
        csv.text(std::to_string(message.log_time_ns)).text(std::to_string(message.publish_time_ns));
        for (const mcap::Value& value : values) add_cell(csv, value);
        csv.end_row();
      });
  csv.finish();
  return io::kDone;
}

}  // namespace

io::Command add_log_csv_command(runtime::CommandLine log) {
  const auto options = std::make_shared<LogCsvOptions>();
  const runtime::CommandLine app =
      log.add_subcommand("csv", "Write a flight, or the messages of a topic, as a CSV table");
  app.add_option("file", options->file, "MCAP file, or the record of a flight").type_name("FILE").required();
  app.add_option("topic", options->topic,
                 "the topic, of which each message is a row; default: ground truth, reference, estimate and "
                 "rotors of "
                 "the flight at 100 Hz, which `swiftlet fly` flies again")
      .type_name("TOPIC");
  app.add_option("--vehicle-name", options->vehicle, "of the vehicles in the file; default: the only one");
  app.add_option("-o,--output", options->output, "the file to write").type_name("FILE").required();
  app.add_flag("--replace", options->replace, "overwrite the file");
  add_time_range_options(app, options->range);
  app.footer(
      "Numbers have the shortest form that reads back as the same value. Of a sequence only its length is "
      "written.\n\nexample: swiftlet log csv flights/20261121-093909-square -o square.csv\n"
      "example: swiftlet log csv flight.mcap /kl1/estimate -o estimate.csv");
  return {app, [options] { return csv(*options); }};
}

}  // namespace swiftlet::ground
