#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/ground/batch/shard.hpp"
#include "swiftlet/ground/cli/analysis/batch_output.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/flight/record_folder.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/io/command_line/progress_line.hpp"

namespace swiftlet::ground {
namespace {

struct MergeOptions {
  std::vector<std::string> shards;  // folders
  std::string out;
  bool replace = false;
  bool json = false;
};

int sim_merge(const MergeOptions& options) {
  std::vector<ShardResult> shards;
  const std::vector<std::filesystem::path> folders(options.shards.begin(), options.shards.end());
  for (const std::filesystem::path& folder : folders) shards.push_back(read_shard(folder));
  BatchReport report = merge(std::move(shards), folders);
  require_space(options.out, batch_bytes(report.batch.requested), "--out");
  const RecordFolder folder(
      options.out, options.replace ? ExistingRecord::kReplaced : ExistingRecord::kRefused, "--out", folders);
  report.folder = folder.path().string();
  io::ProgressLine progress;
  return finish_batch(report, options.json, progress);
}

}  // namespace

io::Command add_sim_merge_command(runtime::CommandLine sim) {
  const auto options = std::make_shared<MergeOptions>();
  const runtime::CommandLine app = sim.add_subcommand("merge", io::purpose_of("sim merge"));
  app.add_option("shards", options->shards,
                 "folders that `swiftlet sim batch --shard` wrote, all of one batch")
      .type_name("FOLDER")
      .required();
  const runtime::Option out =
      app.add_option("--out", options->out, "new folder for batch.csv, batch.html and batch.png")
          .type_name("FOLDER")
          .required();
  app.add_flag("--replace", options->replace, "delete the record that the folder of --out holds first")
      .needs(out);
  app.add_flag("--json", options->json, "print one JSON object instead of the table");
  app.footer(
      "The result is that of the same batch without --shard, byte for byte; its wall_s is the sum over the "
      "shards.\n\nexample: swiftlet sim merge shards/* --out batches/whole");
  return {app, [options] { return sim_merge(*options); }};
}

}  // namespace swiftlet::ground
