// The subcommands of `swiftlet log`, which work on recorded MCAP files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/record/mcap/reader.hpp"

namespace swiftlet::ground {

io::Command add_log_info_command(runtime::CommandLine log);
io::Command add_log_ls_command(runtime::CommandLine log);
io::Command add_log_cut_command(runtime::CommandLine log);
io::Command add_log_merge_command(runtime::CommandLine log);
io::Command add_log_repair_command(runtime::CommandLine log);
io::Command add_log_csv_command(runtime::CommandLine log);
io::Command add_log_npz_command(runtime::CommandLine log);
io::Command add_log_diff_command(runtime::CommandLine log);
io::Command add_log_replay_command(runtime::CommandLine log);

// The part of a file that an option selects: times in s from its first message.
struct TimeRange {
  double from_s = 0.0;
  double to_s = 1e12;

  bool is_given() const { return from_s != 0.0 || to_s != 1e12; }
};
void add_time_range_options(runtime::CommandLine app, TimeRange& range);
mcap::Selection selection_of(const TimeRange& range, const mcap::Reader& file);

// Throws InputError if the file exists and may not be replaced, or is one of the inputs.
void require_new(const std::string& output, bool replace, const std::vector<std::string>& inputs);

}  // namespace swiftlet::ground
