// A part of a batch, flown by a process of its own, on any computer; merge() puts the parts together again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "swiftlet/ground/batch/batch_report.hpp"

namespace swiftlet::ground {

constexpr std::size_t kMostShards = 100'000;
constexpr const char* kShardFile = "shard.json";  // in the folder of a shard

// The part `index` of `count`, from 1.
struct Shard {
  std::size_t index = 1;
  std::size_t count = 1;

  // The runs of a batch of this many that the shard has: a block that differs by at most one run in length from that
  // of every other shard.
  std::size_t first_run(std::size_t runs) const { return runs * (index - 1) / count; }
  std::size_t run_count(std::size_t runs) const { return runs * index / count - first_run(runs); }

  std::string text() const { return std::to_string(index) + "/" + std::to_string(count); }
};

// Reads "I/N". Throws InputError.
Shard parse_shard(const std::string& text);

// What one shard flew, and of which batch it is a part.
struct ShardResult {
  Shard shard;
  std::size_t batch_runs = 0;    // of all shards
  std::uint64_t batch_seed = 0;  // of the first run of all shards
  std::string program;           // with its version
  // Content of the input files by their role: "vehicle", "mission" ...
  std::map<std::string, std::string> inputs;
  BatchReport report;  // of the runs of this shard
};

// The contents of the files that the flights of a plan follow from. Throws io::ConfigError.
std::map<std::string, std::string> read_inputs(const LaunchConfiguration& plan);

// Writes folder/shard.json. Numbers read back exactly. Throws std::runtime_error.
void write_shard(const std::filesystem::path& folder, const ShardResult& result);

// Reads folder/shard.json. Throws InputError, or io::ConfigError if there is none.
ShardResult read_shard(const std::filesystem::path& folder);

// The report of the whole batch, equal to that of a batch without shards but for its wall_s, which is the sum over the
// shards. shards: in any order; folders: theirs, for messages. Throws InputError if one is missing or given twice, or
// if they are not parts of one batch flown by one version of the program.
BatchReport merge(std::vector<ShardResult> shards, const std::vector<std::filesystem::path>& folders);

}  // namespace swiftlet::ground
