#include "swiftlet/ground/batch/shard.hpp"

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/config_error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground::shard_test {

TEST(Shard, BlocksCoverAllRunsOnce) {
  for (const std::size_t runs : {std::size_t{1}, std::size_t{7}, std::size_t{100}, std::size_t{1'000'000}}) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{7}}) {
      if (count > runs) continue;
      std::size_t next = 0;
      for (std::size_t index = 1; index <= count; ++index) {
        const Shard shard{index, count};
        EXPECT_EQ(shard.first_run(runs), next);
        EXPECT_GE(shard.run_count(runs), runs / count);
        EXPECT_LE(shard.run_count(runs), runs / count + 1);
        next += shard.run_count(runs);
      }
      EXPECT_EQ(next, runs);
    }
  }
}

// Two shards of a batch of three runs from seed 5, without flights.
class ShardFile : public testing::Test {
 protected:
  static ShardResult shard(std::size_t index) {
    ShardResult result;
    result.shard = {index, 2};
    result.batch_runs = 3;
    result.batch_seed = 5;
    result.program = "swiftlet 1";
    result.inputs = {{"mission", "name: hop\n"}, {"vehicle", "mass: 1\n"}};
    BatchReport& report = result.report;
    report.mission = "hop";
    report.vehicle = "v";
    report.control = "c";
    report.dispersion = "d";
    report.tolerance_m = 0.1;
    report.repeat = "swiftlet sim fly hop --seed ";
    report.parameters = {"vehicle.mass"};
    report.first_seed = 5 + result.shard.first_run(3);
    report.batch.rejected = index;
    report.batch.wall_s = 0.5;
    report.batch.designed_deg = {60, 61, 62, 31, 32, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < result.shard.run_count(3); ++i) {
      BatchRun run;
      run.seed = report.first_seed + i;
      run.completed = run.seed != 6;
      run.reason = run.completed ? "" : "it went \"away\"";
      run.rms_3d_m = run.completed ? 1.0 / 3.0 / static_cast<double>(run.seed)
                                   : std::numeric_limits<double>::quiet_NaN();
      run.peak_3d_m = 0.1;
      run.duration_s = 6.022;
      run.margins_deg = report.batch.designed_deg;
      run.values = {0.1 * static_cast<double>(run.seed)};
      report.batch.runs.push_back(run);
    }
    return result;
  }

  ShardResult stored(const ShardResult& result) const {
    write_shard(folder_.path(), result);
    return read_shard(folder_.path());
  }

  static void expect_refusal(const std::vector<ShardResult>& shards, const std::string& sentence) {
    try {
      merge(shards, {"a", "b", "c"});
      ADD_FAILURE() << "was merged, must be refused: " << sentence;
    } catch (const io::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
    }
  }

  tests::TemporaryFolder folder_;
};

TEST_F(ShardFile, ReadsBackExactly) {
  const BatchReport whole = merge({stored(shard(2)), stored(shard(1))}, {"a", "b"});
  EXPECT_EQ(whole.first_seed, 5U);
  EXPECT_EQ(whole.batch.requested, 3U);
  EXPECT_EQ(whole.batch.rejected, 3U);
  EXPECT_EQ(whole.batch.wall_s, 1.0);
  EXPECT_EQ(whole.shard, "");
  EXPECT_TRUE(std::isinf(whole.batch.designed_deg.z));
  EXPECT_EQ(whole.repeat_command(6), "swiftlet sim fly hop --seed 6");
  ASSERT_EQ(whole.batch.runs.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const BatchRun& run = whole.batch.runs[i];
    const double seed = 5.0 + static_cast<double>(i);
    EXPECT_EQ(run.seed, 5 + i);
    EXPECT_EQ(run.completed, i != 1);
    EXPECT_EQ(run.values, std::vector<double>{0.1 * seed});
    if (run.completed) {
      EXPECT_EQ(run.rms_3d_m, 1.0 / 3.0 / seed);
    } else {
      EXPECT_TRUE(std::isnan(run.rms_3d_m));
      EXPECT_EQ(run.reason, "it went \"away\"");
    }
  }
  EXPECT_EQ(whole.rms_3d_m.count, 2U) << "spreads are of all runs";
}

TEST_F(ShardFile, RefusesShardsThatAreNotOfOneBatch) {
  const auto changed = [](const std::function<void(ShardResult&)>& change) {
    ShardResult result = shard(2);
    change(result);
    return result;
  };
  expect_refusal({shard(1)}, "shard 2/2 is missing: 1 of 2 are given");
  expect_refusal({shard(1), shard(2), shard(1)}, "shard 1/2 is given twice: a and c");
  expect_refusal({shard(1), changed([](ShardResult& r) { r.shard.count = 3; })},
                 "a and b are not of one batch: one is of 2 shards, the other of 3");
  expect_refusal({shard(1), changed([](ShardResult& r) { r.batch_runs = 4; })}, "--runs is 3 for one, 4");
  expect_refusal({shard(1), changed([](ShardResult& r) { r.batch_seed = 6; })}, "--seed is 5 for one, 6");
  expect_refusal({shard(1), changed([](ShardResult& r) { r.program = "swiftlet 2"; })},
                 "one was flown by swiftlet 1, the other by swiftlet 2");
  expect_refusal({shard(1), changed([](ShardResult& r) { r.inputs["vehicle"] = "mass: 2\n"; })},
                 "their vehicle files differ");
  expect_refusal({shard(1), changed([](ShardResult& r) { r.report.repeat += "--imu-rate 250"; })},
                 "one repeats runs with");
}

TEST_F(ShardFile, RefusesDamagedFiles) {
  EXPECT_THROW(read_shard(folder_.path()), io::ConfigError) << "no file";
  const auto expect_damage = [&](const std::string& text, const std::string& sentence) {
    std::ofstream(folder_.path() / kShardFile) << text;
    try {
      read_shard(folder_.path());
      ADD_FAILURE() << "was read, must be refused: " << sentence;
    } catch (const io::InputError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find("shard.json: is no result of a shard: "), std::string::npos) << what;
      EXPECT_NE(what.find(sentence), std::string::npos) << what;
    }
  };
  expect_damage("{", "parse error");
  expect_damage("[]", "");
  expect_damage("{\"format\": 2}", "format: is 2, must be 1");
  write_shard(folder_.path(), shard(1));
  std::ifstream stream(folder_.path() / kShardFile);
  const std::string good{std::istreambuf_iterator<char>(stream), {}};
  const auto replaced = [&good](const std::string& text, const std::string& by) {
    const std::size_t at = good.find(text);
    EXPECT_NE(at, std::string::npos) << text;
    return std::string(good).replace(at, text.size(), by);
  };
  expect_damage(replaced("\"batch_runs\": 3", "\"batch_runs\": 30"), "has 1 of 15 runs");
  expect_damage(replaced("\"seed\": 5", "\"seed\": 6"), "number 1 has seed 6, must have 5");
  expect_damage(replaced("\"shard\": \"1/2\"", "\"shard\": \"3/2\""), "the shard must be from 1 to 2");
  expect_damage(good.substr(0, good.size() / 2), "parse error");
}

}  // namespace swiftlet::ground::shard_test
