#include <cstdio>
#include <deque>
#include <memory>

#include <fmt/core.h>

#include "swiftlet/ground/cli/analysis/log/log_commands.hpp"
#include "swiftlet/ground/cli/compression_option.hpp"
#include "swiftlet/record/mcap/merge.hpp"

namespace swiftlet::ground {
namespace {

struct LogEditOptions {
  std::vector<std::string> files;
  std::string file;
  std::string output;
  bool replace = false;
  mcap::Compression compression = mcap::Compression::kZstd;
  TimeRange range;
  std::vector<std::string> topics;
};

void add_output_options(runtime::CommandLine app, LogEditOptions& options) {
  app.add_option("-o,--output", options.output, "the file to write").type_name("FILE").required();
  app.add_flag("--replace", options.replace, "overwrite the file");
  add_compression_option(app, options.compression);
}

// Writes the selected messages of the files, and says how many.
void write(const char* command, const std::vector<const mcap::Reader*>& files,
           const mcap::Selection& selection, const LogEditOptions& options) {
  mcap::WriterSettings settings;
  settings.compression = options.compression;
  settings.profile = files.front()->header().profile;
  mcap::Writer out(options.output, settings);
  mcap::merge(files, selection, out);
  out.close();
  fmt::print("{}: {}: {} messages of {} topics\n", command, options.output, out.statistics().message_count,
             out.statistics().messages_by_channel.size());
}

int cut(const LogEditOptions& options) {
  require_new(options.output, options.replace, {options.file});
  const mcap::Reader file(options.file);
  mcap::Selection selection = selection_of(options.range, file);
  selection.topics = {options.topics.begin(), options.topics.end()};
  for (const std::string& topic : selection.topics) {
    bool known = false;
    for (const auto& [id, channel] : file.channels()) known = known || channel.topic == topic;
    if (!known) throw io::InputError("--topic " + topic + ": is not in " + options.file);
  }
  write("cut", {&file}, selection, options);
  return io::kDone;
}

int merge_files(const LogEditOptions& options) {
  require_new(options.output, options.replace, options.files);
  std::deque<mcap::Reader> files;
  std::vector<const mcap::Reader*> sources;
  for (const std::string& name : options.files) sources.push_back(&files.emplace_back(name));
  write("merge", sources, {}, options);
  return io::kDone;
}

int repair(const LogEditOptions& options) {
  require_new(options.output, options.replace, {options.file});
  const mcap::Reader file(options.file, mcap::Access::kScanned);
  for (const mcap::Damage& damage : file.damages())
    fmt::print(stderr, "repair: {}: byte {}: {}\n", options.file, damage.offset, damage.what);
  if (!file.finished()) fmt::print(stderr, "repair: {}: its writer was ended\n", options.file);
  write("repair", {&file}, {}, options);
  return io::kDone;
}

}  // namespace

io::Command add_log_cut_command(runtime::CommandLine log) {
  const auto options = std::make_shared<LogEditOptions>();
  const runtime::CommandLine app = log.add_subcommand("cut", "Write a part of a recorded file");
  app.add_option("file", options->file, "MCAP file").type_name("FILE").required();
  add_output_options(app, *options);
  add_time_range_options(app, options->range);
  app.add_option("--topic", options->topics, "only this topic; may be repeated").repeated();
  app.footer("example: swiftlet log cut flight.mcap --from 10 --to 20 --topic /kl1/imu -o imu.mcap");
  return {app, [options] { return cut(*options); }};
}

io::Command add_log_merge_command(runtime::CommandLine log) {
  const auto options = std::make_shared<LogEditOptions>();
  const runtime::CommandLine app = log.add_subcommand("merge", "Join recorded files in the order of time");
  app.add_option("files", options->files, "MCAP files").type_name("FILE").required();
  add_output_options(app, *options);
  app.footer("example: swiftlet log merge kl1.mcap kl2.mcap -o both.mcap");
  return {app, [options] { return merge_files(*options); }};
}

io::Command add_log_repair_command(runtime::CommandLine log) {
  const auto options = std::make_shared<LogEditOptions>();
  const runtime::CommandLine app = log.add_subcommand(
      "repair", "Write what is readable of a file whose writer was killed or whose bytes are damaged");
  app.add_option("file", options->file, "MCAP file").type_name("FILE").required();
  add_output_options(app, *options);
  app.footer("example: swiftlet log repair killed.mcap -o whole.mcap");
  return {app, [options] { return repair(*options); }};
}

}  // namespace swiftlet::ground
