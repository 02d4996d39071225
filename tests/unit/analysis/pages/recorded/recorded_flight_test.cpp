#include "swiftlet/analysis/pages/recorded/recorded_flight.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/analysis/pages/flight_page.hpp"
#include "swiftlet/analysis/pages/recorded/flight_pieces.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/math/angles.hpp"
#include "swiftlet/record/file/cdr_writer.hpp"
#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/record/mcap/writer.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::pages::recorded_flight_test {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kFirstNs = 500 * kMs;

// A vehicle that climbs at 1 m/s behind its reference by 10 mm. Its log times are 2 s ahead of its stamps.
class FlightFile {
 public:
  explicit FlightFile(const std::string& path) : file_(path, {}) {}
  ~FlightFile() { file_.close(); }
  FlightFile(const FlightFile&) = delete;
  FlightFile& operator=(const FlightFile&) = delete;

  void add(const std::string& topic, const std::string& definition, std::int64_t stamp_ns,
           record::CdrWriter payload) {
    auto channel = channels_.find(topic);
    if (channel == channels_.end()) {
      const std::uint16_t schema =
          file_.add_schema("swiftlet_msgs/msg/T" + std::to_string(channels_.size()), "ros2msg", definition);
      channel = channels_.emplace(topic, file_.add_channel(topic, schema, "cdr", {})).first;
    }
    const mcap::Bytes bytes = payload.take();
    const std::int64_t log_ns = stamp_ns + 2000 * kMs;
    file_.write(mcap::Message{channel->second, 0, log_ns, log_ns, {bytes.data(), bytes.size()}});
  }

  void add_climb(const std::string& vehicle, int samples, control::Mode mode = control::Mode::kTakingOff) {
    for (int i = 0; i < samples; ++i) {
      const std::int64_t stamp_ns = kFirstNs + 10 * kMs * i;
      const double height = 0.01 * i;
      add(vehicle + "/estimate",
          "int64 stamp_ns\nfloat64[3] position_ned\nfloat64[3] velocity_ned\nfloat64[4] q_ned_from_frd\n"
          "float64[3] body_rates_frd\nfloat64[15] standard_deviation\n",
          stamp_ns, estimate(stamp_ns, height));
      add(vehicle + "/reference",
          "int64 stamp_ns\nuint8 mode\nfloat64[3] position_ned\nfloat64[3] velocity_ned\n"
          "float64[4] attitude_setpoint\n",
          stamp_ns, reference(stamp_ns, height + 0.01, mode));
    }
  }

  void add_pose(const std::string& vehicle, std::int64_t stamp_ns) {
    record::CdrWriter payload;
    payload.put(stamp_ns).put(std::uint64_t{1}).put(std::uint64_t{1});
    for (const double value : {0.0, 0.0, -0.05, 1.0, 0.0, 0.0, 0.0}) payload.put(value);
    add(vehicle + "/mocap_pose",
        "int64 stamp_ns\nuint64 sequence_number\nuint64 tracked\nfloat64[3] position_ned\n"
        "float64[4] q_ned_from_frd\n",
        stamp_ns, std::move(payload));
  }

  void attach(const std::string& name, const std::string& text) {
    file_.write(mcap::Attachment{0, 0, name, "application/yaml", text});
  }

  void describe(const mcap::Metadata& metadata) { file_.write(metadata); }

  void add_mission(const std::string& vehicle, std::int64_t stamp_ns) {
    record::CdrWriter payload;
    payload.put(stamp_ns)
        .put(std::uint64_t{7})
        .put(static_cast<std::uint8_t>(control::MissionState::kRunning));
    payload.put(std::uint32_t{0}).put(std::uint32_t{3}).text("");
    add(vehicle + "/mission_status",
        "int64 stamp_ns\nuint64 mission_id\nuint8 state\nuint32 item_index\nuint32 item_count\nstring "
        "reason\n",
        stamp_ns, std::move(payload));
  }

  void add_mode(const std::string& vehicle, std::int64_t stamp_ns, std::uint8_t mode,
                const std::string& reason) {
    record::CdrWriter payload;
    payload.put(stamp_ns).put(mode).text(reason);
    add(vehicle + "/control_status", "int64 stamp_ns\nuint8 mode\nstring reason\n", stamp_ns,
        std::move(payload));
  }

 private:
  static record::CdrWriter estimate(std::int64_t stamp_ns, double height) {
    record::CdrWriter payload;
    payload.put(stamp_ns);
    for (const double value : {0.0, 0.0, -height, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0})
      payload.put(value);
    for (int i = 0; i < 15; ++i) payload.put(1e-3);
    return payload;
  }
  static record::CdrWriter reference(std::int64_t stamp_ns, double height, control::Mode mode) {
    record::CdrWriter payload;
    payload.put(stamp_ns).put(static_cast<std::uint8_t>(mode));
    for (const double value : {0.0, 0.0, -height, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0}) payload.put(value);
    return payload;
  }

  mcap::Writer file_;
  std::map<std::string, std::uint16_t> channels_;
};

std::string value_of(const FlightLog& flight, const std::string& label) {
  for (const auto& [name, value] : flight.summary) {
    if (name == label) return value;
  }
  return "";
}

class FlightPage : public testing::Test {
 protected:
  std::vector<FlightLog> flights() const {
    const mcap::Reader file(path_);
    const auto recorded = record::read_flights(file);
    std::vector<FlightLog> flights;
    for (const std::string& vehicle : record::recorded_vehicles(file))
      flights.push_back(flight_log(file, vehicle, recorded.at(vehicle), vehicle));
    return flights;
  }

  tests::TemporaryFolder folder_;
  const std::string path_ = folder_.path() / "flight.mcap";
};

TEST_F(FlightPage, HasErrorsAgainstTheReferenceOverTheTimeSinceTakeOff) {
  {
    FlightFile file(path_);
    file.add_climb("/kl1", 200);
    file.add_mode("/kl1", kFirstNs, 0, "started");
    file.add_mode("/kl1", kFirstNs + 100 * kMs, 2, "requested");
  }
  const FlightLog flight = flights().at(0);
  EXPECT_EQ(flight.name, "kl1");
  EXPECT_EQ(flight.vehicle, "kl1");
  EXPECT_FALSE(flight.has_truth);
  EXPECT_NEAR(flight.start_s, -0.1, 1e-9);
  EXPECT_NEAR(flight.end_s, 1.89, 1e-9);
  const SignalTable& reference = flight.tables.at("reference");
  ASSERT_EQ(reference.time_s.size(), 200U);
  EXPECT_NEAR(reference.signals.at("error_down")[50], 10.0, 1e-9);
  EXPECT_EQ(value_of(flight, "error 3-D, RMS"), "10.00 mm");
  EXPECT_NEAR(flight.tables.at("estimate").signals.at("bound_down")[7], 3.0, 1e-9);
  ASSERT_EQ(flight.modes.size(), 2U);
  EXPECT_EQ(flight.modes[1].mode, "taking off");
  EXPECT_NEAR(flight.modes[1].time_s, 0.0, 1e-9);
  EXPECT_EQ(flight.events[1].text, "taking off: requested");
}

TEST_F(FlightPage, CountsTimeFromTheStartOfTheMission) {
  {
    FlightFile file(path_);
    file.add_mode("/kl1", kFirstNs, 2, "requested");
    file.add_climb("/kl1", 50);
    file.add_mission("/kl1", kFirstNs + 500 * kMs);
    file.add_climb("/kl1", 200, control::Mode::kMission);
  }
  const FlightLog flight = flights().at(0);
  EXPECT_NEAR(flight.start_s, -0.5, 1e-9);
}

// A turn over south, held to the end; the setpoint is on the other side of it.
TEST(FlightSignals, YawIsContinuousAndTheReferenceNearIt) {
  record::Flight recorded;
  const auto turned = [](double yaw_deg) {
    return std::array<double, 4>{std::cos(yaw_deg / 2 / math::kDegPerRad), 0.0, 0.0,
                                 std::sin(yaw_deg / 2 / math::kDegPerRad)};
  };
  const std::vector<double> flown_deg = {-1.0, 90.0, 170.0, 179.0, 181.0, 270.0, 365.0};
  for (std::size_t i = 0; i < flown_deg.size(); ++i) {
    record::TruthRow truth;
    truth.stamp_ns = static_cast<std::int64_t>(i) * 10 * kMs;
    truth.q_ned_from_frd = turned(flown_deg[i]);
    recorded.truth.push_back(truth);
    record::ReferenceRow reference;
    reference.stamp_ns = truth.stamp_ns;
    reference.mode = static_cast<int>(control::Mode::kMission);
    reference.q_ned_from_frd = turned(flown_deg[i] + 2.0);
    recorded.reference.push_back(reference);
  }
  FlightLog flight;
  flight.has_truth = true;
  add_signals(recorded, {}, {}, flight);
  for (std::size_t i = 0; i < flown_deg.size(); ++i) {
    EXPECT_NEAR(flight.tables.at("path").signals.at("yaw").at(i), flown_deg[i], 1e-9);
    EXPECT_NEAR(flight.tables.at("reference").signals.at("yaw").at(i), flown_deg[i] + 2.0, 1e-9);
  }
}

TEST_F(FlightPage, HoldsEachVehicleAndEscapesTexts) {
  {
    FlightFile file(path_);
    file.add_climb("/a", 20);
    file.add_climb("/b", 20);
    file.add_mode("/b", kFirstNs, 9, "</script><b>");
  }
  const std::vector<FlightLog> both = flights();
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[1].name, "b");
  const std::string page = flight_page("Flights <of> test", "note", both);
  EXPECT_NE(page.find("<title>Flights &lt;of&gt; test</title>"), std::string::npos);
  EXPECT_EQ(page.find("</script><b>"), std::string::npos);
  EXPECT_NE(page.find("<td>stopped: &lt;/script&gt;&lt;b&gt;</td>"), std::string::npos);
  EXPECT_EQ(page.find("<script src"), std::string::npos) << "loads another file";
}

TEST_F(FlightPage, KnowsMotionCaptureFromTheAttachedSettingsOfTheVehicle) {
  {
    FlightFile file(path_);
    for (const char* const vehicle : {"/a", "/b"}) {
      file.add_climb(vehicle, 20);
      file.add_pose(vehicle, kFirstNs + 50 * kMs);
    }
    file.attach("control.yaml", "estimator: {mocap_position_m: 0.002, mocap_orientation_rad: 0.01}\n");
    file.attach("b/control.yaml", "estimator: {mocap_position_m: 0.004, mocap_orientation_rad: 0.02}\n");
    file.attach("motor_lag.yaml", "estimator: {mocap_position_m: 1}\n");
  }
  const std::vector<FlightLog> both = flights();
  // 3 sigma of an estimate with 1 mm and of motion capture together.
  const auto bound_mm = [&](std::size_t vehicle) {
    return both.at(vehicle).tables.at("innovation").signals.at("bound_down").at(0);
  };
  EXPECT_NEAR(bound_mm(0), 3.0 * std::hypot(1.0, 2.0), 1e-9);
  EXPECT_NEAR(bound_mm(1), 3.0 * std::hypot(1.0, 4.0), 1e-9);
}

// At their times on the axis of the page, which here begins at the take-off, and only those that began before its end.
TEST_F(FlightPage, MarksTheFaultsOfTheAttachedSimulation) {
  {
    FlightFile file(path_);
    file.add_climb("/kl1", 100);
    file.add_mode("/kl1", kFirstNs + 200 * kMs, 2, "requested");
    file.attach("simulation.yaml", io::read_text_file(tests::in_source("config/simulation/default.yaml")) +
                                       "faults:\n  - {kind: mocap_stop, at_s: 1.2, for_s: 0.1}\n"
                                       "  - {kind: imu_stop, at_s: 9, for_s: 0.1}\n");
  }
  const std::vector<FlightEvent> events = flights().front().events;
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[1].kind, "fault");
  EXPECT_EQ(events[1].text, "fault: mocap_stop, at_s 1.2, for_s 0.1");
  EXPECT_NEAR(events[1].time_s, 0.5, 1e-9);
}

TEST_F(FlightPage, HasTheMissionAndSeedOfTheVehicle) {
  {
    FlightFile file(path_);
    file.describe({"swiftlet/flight",
                   {{"vehicles", "kl1,kl2"}, {"missions", "square,hop"}, {"seed", "5"}, {"seeds", "5,6"}}});
    file.add_climb("/kl1", 10);
    file.add_climb("/kl2", 10);
  }
  const std::vector<FlightLog> both = flights();
  EXPECT_EQ(value_of(both[0], "mission"), "square");
  EXPECT_EQ(value_of(both[0], "seed"), "5");
  EXPECT_EQ(value_of(both[1], "mission"), "hop");
  EXPECT_EQ(value_of(both[1], "seed"), "6");
}

TEST_F(FlightPage, NamesASignalOfAnotherType) {
  const auto fault_of = [&](const std::string& definition, record::CdrWriter payload) -> std::string {
    {
      FlightFile file(path_);
      file.add_climb("/kl1", 20);
      file.add("/kl1/control_status", definition, kFirstNs, std::move(payload));
    }
    try {
      flights();
    } catch (const io::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  record::CdrWriter payload;
  payload.put(kFirstNs).text("holding").put(2.0);
  EXPECT_NE(fault_of("int64 stamp_ns\nstring mode\nfloat64 x\n", std::move(payload))
                .find("/kl1/control_status: mode is a text, must be a number"),
            std::string::npos);
  payload = record::CdrWriter();
  payload.put(kFirstNs).put(std::uint8_t{2}).put(2.0);
  EXPECT_NE(fault_of("int64 stamp_ns\nuint8 mode\nfloat64 reason\n", std::move(payload))
                .find("/kl1/control_status: reason is a number, must be a text"),
            std::string::npos);
  payload = record::CdrWriter();
  payload.put(kFirstNs).put(std::uint32_t{0});
  EXPECT_NE(fault_of("int64 stamp_ns\nuint8[] mode\n", std::move(payload))
                .find("/kl1/control_status: mode is a sequence, must be a number"),
            std::string::npos);
  payload = record::CdrWriter();
  payload.text("now").put(std::uint8_t{2});
  EXPECT_NE(fault_of("string stamp_ns\nuint8 mode\n", std::move(payload))
                .find("/kl1/control_status: stamp_ns is a text, must be a number"),
            std::string::npos);
}

TEST_F(FlightPage, CountsTheVehicles) {
  {
    FlightFile file(path_);
    for (const char* const vehicle : {"/kl10", "/kl2"}) file.add_climb(vehicle, 20);
  }
  EXPECT_EQ(flights().at(0).vehicle, "kl2");
  EXPECT_EQ(flights().at(1).vehicle, "kl10");
}

TEST_F(FlightPage, SaysWhatIsMissing) {
  {
    FlightFile file(path_);
    file.add_mode("/kl1", kFirstNs, 0, "started");
  }
  try {
    flights();
    FAIL() << "a file without a flight was accepted";
  } catch (const io::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("holds no flight"), std::string::npos) << error.what();
  }
}

}  // namespace swiftlet::pages::recorded_flight_test
