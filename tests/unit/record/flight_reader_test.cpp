// Flights in MCAP files. The schemas are small ones of these tests: signals are found by their names.
#include "swiftlet/record/file/flight_reader.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "swiftlet/io/byte_writer.hpp"
#include "swiftlet/record/mcap/series.hpp"
#include "swiftlet/record/mcap/writer.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::record::flight_reader_test {

using tests::refusal;

// Little-endian CDR of numbers of 8 bytes.
class Payload {
 public:
  template <class Number>
  Payload& put(Number number) {
    static_assert(sizeof(number) == 8);
    io::append(bytes_, number);
    return *this;
  }
  Payload& put(std::initializer_list<double> numbers) {
    for (const double number : numbers) put(number);
    return *this;
  }
  mcap::ByteView view() const { return {bytes_.data(), bytes_.size()}; }

 private:
  mcap::Bytes bytes_ = {0, 1, 0, 0};
};

constexpr std::int64_t kStep_ns = 2'000'000;

class FlightReader : public testing::Test {
 protected:
  FlightReader() : file_(path_, {}) {}

  std::uint16_t channel(const std::string& topic, const std::string& type, const std::string& definition) {
    return file_.add_channel(topic, file_.add_schema("swiftlet_msgs/msg/" + type, "ros2msg", definition),
                             "cdr", {});
  }
  void write(std::uint16_t channel, std::int64_t time_ns, const Payload& payload) {
    file_.write(mcap::Message{channel, 1, time_ns, time_ns, payload.view()});
  }
  // Four IMU samples and their commands; a pose.
  void write_flight(const std::string& vehicle) {
    const auto imu = channel("/" + vehicle + "/imu", "Imu",
                             "int64 stamp_ns\nuint64 sequence_number\nfloat64[3] specific_force_frd\n"
                             "float64[3] body_rates_frd\n");
    const auto command = channel(
        "/" + vehicle + "/actuator_command", "ActuatorCommand",
        "int64 stamp_ns\nuint64 sequence_number\nuint64 imu_sequence_number\n"
        "uint64 mocap_sequence_number\nuint64 rotor_state\nuint64 rotor_count\nfloat64[8] throttle\n");
    const auto pose = channel("/" + vehicle + "/mocap_pose", "MocapPose",
                              "int64 stamp_ns\nuint64 sequence_number\nuint64 tracked\n"
                              "float64[3] position_ned\nfloat64[4] q_ned_from_frd\n");
    for (std::int64_t i = 0; i < 4; ++i) {
      const std::int64_t stamp_ns = i * kStep_ns;
      const auto n = static_cast<std::uint64_t>(i + 1);
      write(imu, stamp_ns, Payload().put(stamp_ns).put(n).put({0.1, 0.2, -9.8}).put({0.01 * i, 0.0, 0.0}));
      write(command, stamp_ns + 1000,
            Payload()
                .put(stamp_ns)
                .put(n)
                .put(n)
                .put(n)
                .put(n)
                .put(std::uint64_t{4})
                .put({0.5, 0.6, 0.7, 0.8, 0.0, 0.0, 0.0, 0.0}));
    }
    write(pose, kStep_ns,
          Payload().put(kStep_ns).put(std::uint64_t{0}).put(std::uint64_t{0}).put({0, 0, 0, 0, 0, 0, 0}));
    write(pose, kStep_ns,
          Payload()
              .put(kStep_ns)
              .put(std::uint64_t{1})
              .put(std::uint64_t{1})
              .put({1.0, 2.0, -3.0, 1.0, 0.0, 0.0, 0.0}));
  }
  mcap::Reader recorded() {
    file_.close();
    return mcap::Reader(path_);
  }

  tests::TemporaryFolder folder_;
  const std::string path_ = folder_.path() / "flight.mcap";
  mcap::Writer file_;
};

TEST_F(FlightReader, HasColumnsOverTime) {
  const auto topic =
      channel("/kl1/battery", "Battery", "int64 stamp_ns\nfloat64 voltage_v\nuint64 id\nstring text\n");
  mcap::Bytes bytes = {0, 1, 0, 0};
  const auto put = [&](auto value) { io::append(bytes, value); };
  put(std::int64_t{9'007'199'254'740'993});  // not a double
  put(4.1);
  put(std::uint64_t{9'007'199'254'740'995});
  put(std::uint32_t{4});
  bytes.insert(bytes.end(), {'l', 'o', 'w', 0});
  file_.write(mcap::Message{topic, 1, 50, 40, {bytes.data(), bytes.size()}});
  const mcap::Reader file = recorded();
  const mcap::Series battery = mcap::read_series(file, {}).at("/kl1/battery");
  ASSERT_EQ(battery.size(), 1U);
  EXPECT_EQ(battery.log_time_ns()[0], 50);
  EXPECT_EQ(battery.stamp_ns()[0], 9'007'199'254'740'993);
  EXPECT_EQ(battery.numbers("voltage_v")[0], 4.1);
  EXPECT_EQ(battery.integers("id")[0], 9'007'199'254'740'995U);
  EXPECT_EQ(battery.texts("text")[0], "low");
  EXPECT_EQ(battery.number_names(), (std::vector<std::string>{"stamp_ns", "voltage_v", "id"}));
  EXPECT_FALSE(battery.has_numbers("text"));
  EXPECT_NE(refusal([&] { (void)battery.numbers("voltage"); }).find("/kl1/battery: has no signal voltage"),
            std::string::npos);
}

TEST_F(FlightReader, HasTheSamplesOfAVehicle) {
  write_flight("kl1");
  const mcap::Reader file = recorded();
  EXPECT_TRUE(is_mcap(path_));
  EXPECT_EQ(recorded_vehicle(file, ""), "kl1");
  const Flight flight = read_flight(file, "kl1");
  ASSERT_EQ(flight.imu.size(), 4U);
  EXPECT_EQ(flight.imu[3].stamp_ns, 3 * kStep_ns);
  EXPECT_EQ(flight.imu[3].specific_force_frd, Eigen::Vector3d(0.1, 0.2, -9.8));
  EXPECT_EQ(flight.imu[3].body_rates_frd.x(), 0.03);
  ASSERT_EQ(flight.commands.size(), 4U);
  EXPECT_EQ(flight.commands[2].rotor_count, 4);
  EXPECT_EQ(flight.commands[2].throttle[3], 0.8);
  EXPECT_EQ(flight.commands_sent_ns[2] - flight.imu_sent_ns[2], 1000);
  ASSERT_EQ(flight.poses.size(), 1U) << "not the heartbeat without a pose";
  EXPECT_EQ(flight.poses[0].position_ned.z(), -3.0);
  EXPECT_TRUE(flight.batteries.empty());
}

TEST_F(FlightReader, OfSeveralVehiclesNeedsAName) {
  write_flight("kl1");
  write_flight("kl2");
  channel("/kl3/imu", "Imu", "int64 stamp_ns\n");
  const mcap::Reader file = recorded();
  EXPECT_EQ(recorded_vehicles(file), (std::vector<std::string>{"kl1", "kl2"})) << "kl3 sent nothing";
  EXPECT_EQ(recorded_vehicle(file, "kl2"), "kl2");
  EXPECT_NE(refusal([&] { recorded_vehicle(file, ""); }).find("has the vehicles kl1, kl2; choose one"),
            std::string::npos);
  EXPECT_NE(refusal([&] { recorded_vehicle(file, "kl3"); }).find("has no vehicle kl3"), std::string::npos);
}

TEST_F(FlightReader, LeavesOutRepeatedAndInvalidSamples) {
  const auto imu = channel("/kl1/imu", "Imu",
                           "int64 stamp_ns\nuint64 sequence_number\nfloat64[3] specific_force_frd\n"
                           "float64[3] body_rates_frd\n");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto sample = [&](std::int64_t stamp_ns, double x) {
    write(imu, stamp_ns,
          Payload().put(stamp_ns).put(std::uint64_t{1}).put({x, 0.0, -9.8}).put({0.0, 0.0, 0.0}));
  };
  sample(1000, 1.0);
  sample(1000, 2.0);
  sample(2000, nan);
  sample(3000, 3.0);
  const mcap::Reader file = recorded();
  const Flight flight = read_flight(file, "kl1");
  ASSERT_EQ(flight.imu.size(), 2U);
  EXPECT_EQ(flight.imu[0].specific_force_frd.x(), 1.0);
  EXPECT_EQ(flight.imu[1].specific_force_frd.x(), 3.0);
  EXPECT_TRUE(flight.truth.empty());
}

TEST_F(FlightReader, WithoutASignalIsRefused) {
  const auto imu = channel("/kl1/imu", "Imu", "int64 stamp_ns\nuint64 sequence_number\n");
  write(imu, 1, Payload().put(std::int64_t{1}).put(std::uint64_t{1}));
  const mcap::Reader file = recorded();
  EXPECT_NE(refusal([&] { read_flight(file, "kl1"); }).find("/kl1/imu: has no signal specific_force"),
            std::string::npos);
}

}  // namespace swiftlet::record::flight_reader_test
