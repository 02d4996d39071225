// Binary logs of the Crazyflie's uSD logger, written here as its firmware writes them.
#include "swiftlet/io/missions/crazyflie_log.hpp"

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>
#include <zlib.h>

#include <gtest/gtest.h>

#include "swiftlet/io/byte_writer.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/io/missions/format_support.hpp"

namespace swiftlet::io::crazyflie_log_test {

using Eigen::Vector3d;

template <class Number>
std::string raw(Number number) {
  std::string bytes;
  append(bytes, number);
  return bytes;
}

struct LogType {
  std::uint16_t id;
  std::string name;
  std::vector<std::string> variables;
};

std::string header(std::uint16_t version, const std::vector<LogType>& types) {
  std::string bytes = "\xBC" + raw(version) + raw(static_cast<std::uint16_t>(types.size()));
  for (const LogType& type : types) {
    bytes += raw(type.id) + type.name + '\0' + raw(static_cast<std::uint16_t>(type.variables.size()));
    for (const std::string& variable : type.variables) bytes += variable + '\0';
  }
  return bytes;
}
std::string closed(const std::string& bytes) {
  const auto* const data = reinterpret_cast<const unsigned char*>(bytes.data());
  return bytes + raw(static_cast<std::uint32_t>(crc32_z(0, data, bytes.size())));
}

const std::vector<LogType> kTypes = {{7, "estTDOA", {"idA(B)", "idB(B)", "distanceDiff(f)"}},
                                     {300,
                                      "fixedFrequency",
                                      {"range.zrange(H)", "stateEstimate.x(f)", "stateEstimate.y(f)",
                                       "stateEstimate.z(f)", "pm.vbat(e)", "stateEstimate.yaw(f)"}}};

std::string stamp(std::uint16_t version, double t_s) {
  return version == 1 ? raw(static_cast<std::uint32_t>(std::lround(1e3 * t_s)) + 123456U)
                      : raw(static_cast<std::uint64_t>(std::llround(1e6 * t_s)) + 9'000'000'000ULL);
}

// A minimum-jerk flight of 4 s at 100 Hz from (0, 0, 0.5) to (1, 0.5, 1) after a rest of 1 s, with other events between.
std::string flight(std::uint16_t version) {
  std::string bytes = header(version, kTypes);
  const control::PolynomialSegment path = control::minimum_jerk({0, 0, 0.5}, 0.0, {1, 0.5, 1}, 1.0, 4.0);
  for (int i = 0; i <= 600; ++i) {
    const double t_s = 0.01 * i;
    const control::Reference at = control::evaluate(path, t_s - 1.0);
    const auto number = [](double value) { return raw(static_cast<float>(value)); };
    bytes += raw(std::uint16_t{300}) + stamp(version, t_s) + raw(std::uint16_t{1200}) +
             number(at.position_ned.x()) + number(at.position_ned.y()) + number(at.position_ned.z()) +
             raw(std::uint16_t{0x4400}) + number(at.yaw_rad * 180.0 / M_PI);
    if (i % 3 == 0)
      bytes += raw(std::uint16_t{7}) + stamp(version, t_s + 0.001) + raw(std::uint8_t{1}) +
               raw(std::uint8_t{2}) + number(0.1);
  }
  return closed(bytes);
}

class CrazyflieLogTest : public testing::Test {
 protected:
  MissionFile load(const std::string& bytes, const FileOptions& options) const {
    return load_mission_file(folder_.write("log00", bytes), field(), options);
  }
  static std::string refused(const std::string& bytes) {
    return refusal([&] { read_crazyflie_log(bytes, "log00"); });
  }

  tests::TemporaryFolder folder_;
};

TEST_F(CrazyflieLogTest, TheEstimateOfBothVersionsIsFlown) {
  for (const std::uint16_t version : {1, 2}) {
    FileOptions options;
    options.frame = MissionFrame::kNwu;
    options.from_s = 1.0;
    options.until_s = 5.0;
    const MissionFile file = load(flight(version), options);
    double duration_s = 0.0;
    for (const control::PolynomialSegment& segment : file.mission.segments) duration_s += segment.duration_s;
    EXPECT_NEAR(duration_s, 4.0, 1e-6) << "between --from and --until";
    EXPECT_LT((at_path_start(file).position_ned - Vector3d(0, 0, -0.5)).norm(), 1e-5);
    EXPECT_NEAR(at_path_start(file).yaw_rad, 0.0, 1e-4);
    const control::PolynomialSegment& last = file.mission.segments.back();
    const control::Reference end = control::evaluate(last, last.duration_s);
    EXPECT_LT((end.position_ned - Vector3d(1, -0.5, -1)).norm(), 1e-5);
    EXPECT_NEAR(end.yaw_rad, -1.0, 1e-4);
    EXPECT_TRUE(assumes(file, "the estimated position and yaw of its 601 events fixedFrequency"));
  }
}

TEST_F(CrazyflieLogTest, AYawComesFromTheQuaternionIfThatIsLogged) {
  const std::vector<LogType> types = {
      {1,
       "fixedFrequency",
       {"stateEstimate.x(f)", "stateEstimate.y(f)", "stateEstimate.z(f)", "stateEstimate.qw(f)",
        "stateEstimate.qx(f)", "stateEstimate.qy(f)", "stateEstimate.qz(f)"}}};
  std::string bytes = header(2, types) + raw(std::uint16_t{1}) + raw(std::uint64_t{5});
  for (const float value : {0.5F, -0.25F, 1.0F, std::sqrt(0.5F), 0.0F, 0.0F, std::sqrt(0.5F)})
    bytes += raw(value);
  const Table table = read_crazyflie_log(closed(bytes), "log00").table;
  EXPECT_EQ(table.columns(), (std::vector<std::string>{"t", "x", "y", "z", "yaw"}));
  EXPECT_EQ(table.row_count(), 1U);
  EXPECT_EQ(table.row(0), (std::vector<double>{0.0, 0.5, -0.25, 1.0, 1.5708}));
  EXPECT_NEAR(table.last_digit(0, 1), 1e-6, 1e-15);
}

TEST_F(CrazyflieLogTest, IsRefusedIfItIsCutOrDamagedOrOther) {
  const std::string whole = flight(2);
  for (const std::size_t size : {std::size_t{1}, std::size_t{8}, std::size_t{100}, whole.size() - 1}) {
    const std::string sentence = refused(whole.substr(0, size));
    EXPECT_TRUE(sentence.find("cut or damaged") != std::string::npos ||
                sentence.find("a log of the Crazyflie has at least 9") != std::string::npos)
        << sentence;
  }
  std::string damaged = whole;
  damaged[2000] = static_cast<char>(damaged[2000] ^ 1);
  EXPECT_NE(refused(damaged).find("cut or damaged"), std::string::npos);
  EXPECT_EQ(refused(closed(header(3, kTypes))), "log00: is of version 3, must be of 1 or 2");
  EXPECT_EQ(refused(closed(header(1, {kTypes.front()}))),
            "log00: has no event with stateEstimate.x, stateEstimate.y and stateEstimate.z; it has ida, idb, "
            "distancediff");
  EXPECT_NE(refused(closed(header(1, {{1, "e", {"x(z)"}}}))).find("has the variable x(z), must be"),
            std::string::npos);
  EXPECT_EQ(refused(closed(header(1, kTypes) + raw(std::uint16_t{9}) + raw(std::uint32_t{1}))),
            "log00: has event 1 of type 9, which it does not describe");
  EXPECT_EQ(refused(closed(header(1, kTypes) + raw(std::uint16_t{7}) + raw(std::uint32_t{1}))),
            "log00: ends within event 1");
  EXPECT_EQ(refused(closed(header(1, kTypes).substr(0, 20))),
            "log00: ends within the description of event type 1 of 2");
}

TEST_F(CrazyflieLogTest, ACutNeedsTwoSamples) {
  FileOptions options;
  options.from_s = 7.0;
  const std::string sentence = refusal([&] { load(flight(1), options); });
  EXPECT_NE(sentence.find("has 0 samples from 7 to 6 s, must have at least 2: its last is at 6 s"),
            std::string::npos)
      << sentence;
  const std::string plan = folder_.write("w.csv", "x,y,z\n0,0,1\n1,0,1\n");
  EXPECT_NE(
      refusal([&] { load_mission_file(plan, field(), options); }).find("--from and --until are for those"),
      std::string::npos);
}

}  // namespace swiftlet::io::crazyflie_log_test
