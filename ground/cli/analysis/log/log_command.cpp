#include <filesystem>

#include <fmt/core.h>

#include "swiftlet/ground/cli/analysis/log/log_commands.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/command_line/output_files.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::ground {

void add_time_range_options(runtime::CommandLine app, TimeRange& range) {
  app.add_option("--from", range.from_s, "begin at this time after the first message, s").range(0.0, 1e9);
  app.add_option("--to", range.to_s, "end before this time after the first message, s").range(0.0, 1e12);
}

mcap::Selection selection_of(const TimeRange& range, const mcap::Reader& file) {
  if (range.to_s <= range.from_s)
    throw io::InputError(fmt::format("--to {:g}: is not after --from {:g}", range.to_s, range.from_s));
  const std::int64_t start_ns = file.statistics().start_ns;
  mcap::Selection selection;
  selection.from_ns = start_ns + static_cast<std::int64_t>(range.from_s * math::kNsPerS);
  if (range.to_s < 1e9) selection.to_ns = start_ns + static_cast<std::int64_t>(range.to_s * math::kNsPerS);
  return selection;
}

void require_new(const std::string& output, bool replace, const std::vector<std::string>& inputs) {
  io::refuse_overwriting({{"--output", output}}, {inputs.begin(), inputs.end()});
  if (std::filesystem::is_regular_file(output) && !replace)
    throw io::InputError("--output " + output +
                         ": exists; choose another name, or add --replace to overwrite it");
}

io::Command add_log_command(runtime::CommandLine root) {
  const runtime::CommandLine app = root.add_subcommand("log", io::purpose_of("log"));
  app.require_subcommand(1, 1);
  const std::vector<io::Command> commands = {
      add_log_info_command(app),  add_log_ls_command(app),     add_log_cut_command(app),
      add_log_merge_command(app), add_log_repair_command(app), add_log_csv_command(app),
      add_log_npz_command(app),   add_log_diff_command(app),   add_log_replay_command(app)};
  app.footer("example: swiftlet log info flight.mcap");
  return {app, [commands] { return io::run_given(commands); }};
}

}  // namespace swiftlet::ground
