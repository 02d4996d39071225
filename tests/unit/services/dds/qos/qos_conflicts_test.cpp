// Reports about endpoints of one topic whose QoS is incompatible.
#include "swiftlet/services/dds/qos/qos_conflicts.hpp"

#include <algorithm>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/support/eventually.hpp"

namespace swiftlet::dds::qos_conflicts_test {

namespace fastdds = eprosima::fastdds::dds;
using swiftlet::tests::eventually;
using swiftlet::tests::Inbox;
using namespace std::chrono_literals;

EndpointQos offer() { return endpoint_qos(fastdds::DataWriterQos()); }
EndpointQos demand() { return endpoint_qos(fastdds::DataReaderQos()); }

TEST(QosConflicts, DefaultsMatch) { EXPECT_EQ(conflicts(offer(), demand()), ""); }

TEST(QosConflicts, ListEachPolicyWithBothValues) {
  EndpointQos offered = offer();
  offered.reliability = fastdds::BEST_EFFORT_RELIABILITY_QOS;
  EndpointQos requested = demand();
  requested.reliability = fastdds::RELIABLE_RELIABILITY_QOS;
  EXPECT_EQ(conflicts(offered, requested), "reliability (offered best effort, requested reliable)");

  offered.durability = fastdds::VOLATILE_DURABILITY_QOS;
  requested.durability = fastdds::TRANSIENT_LOCAL_DURABILITY_QOS;
  requested.ownership = fastdds::EXCLUSIVE_OWNERSHIP_QOS;
  requested.deadline = {0, 50'000'000U};
  requested.liveliness = fastdds::MANUAL_BY_TOPIC_LIVELINESS_QOS;
  requested.lease = {2, 0U};
  requested.without_positive_acks = true;
  EXPECT_EQ(conflicts(offered, requested),
            "reliability (offered best effort, requested reliable), "
            "durability (offered volatile, requested transient local), "
            "ownership (offered shared, requested exclusive), "
            "deadline (offered none, requested 50 ms), "
            "liveliness (offered automatic, requested manual by topic), "
            "liveliness lease (offered none, requested 2000 ms), "
            "disabled positive acknowledgements (offered no, requested yes)");
}

TEST(QosConflicts, MatchWhenMoreIsOfferedThanRequested) {
  EndpointQos offered = offer();
  offered.reliability = fastdds::RELIABLE_RELIABILITY_QOS;
  offered.durability = fastdds::TRANSIENT_LOCAL_DURABILITY_QOS;
  offered.deadline = {0, 10'000'000U};
  EndpointQos requested = demand();
  requested.reliability = fastdds::BEST_EFFORT_RELIABILITY_QOS;
  requested.durability = fastdds::VOLATILE_DURABILITY_QOS;
  requested.deadline = {0, 50'000'000U};
  EXPECT_EQ(conflicts(offered, requested), "");
}

class LineSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit LineSink(Inbox<std::string>& lines) : lines_(lines) {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    lines_.put(std::string(message.payload.data(), message.payload.size()));
  }
  void flush_() override {}
  Inbox<std::string>& lines_;
};

// Collects log lines during its lifetime. No other thread may log at its construction and destruction.
class CollectedLog {
 public:
  explicit CollectedLog(Inbox<std::string>& lines) : before_(spdlog::default_logger()) {
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", std::make_shared<LineSink>(lines)));
  }
  ~CollectedLog() { spdlog::set_default_logger(before_); }
  CollectedLog(const CollectedLog&) = delete;
  CollectedLog& operator=(const CollectedLog&) = delete;

 private:
  std::shared_ptr<spdlog::logger> before_;
};

// Two processes, "talker" and "listener", whose log lines are collected.
class QosConflictLog : public testing::Test {
 protected:
  NodeSettings settings(const char* name) const {
    NodeSettings settings;
    settings.name = name;
    settings.domain = lock_.domain();
    return settings;
  }

  // Number of lines that contain all of these words.
  static long count(const std::vector<std::string>& lines, const std::vector<std::string>& words) {
    return std::count_if(lines.begin(), lines.end(), [&](const std::string& line) {
      return std::all_of(words.begin(), words.end(),
                         [&](const std::string& word) { return line.find(word) != std::string::npos; });
    });
  }
  bool is_logged(const std::vector<std::string>& words) const {
    return lines_.wait([&](const auto& lines) { return count(lines, words) > 0; });
  }
  std::string all_lines() const {
    std::string text;
    for (const std::string& line : lines_.items()) text += line + "\n";
    return text;
  }

  DomainLock lock_;
  Inbox<std::string> lines_;
  const CollectedLog log_{lines_};
  Node talker_{settings("talker")};
  Node listener_{settings("listener")};
};

constexpr messages::Topic<messages::msg::Imu> kReliableImu{"imu", messages::Qos::kRequest};

TEST_F(QosConflictLog, NamesTopicPolicyAndPeerOnBothSides) {
  const auto publisher = talker_.publish(messages::topics::kImu);
  const auto subscription =
      listener_.subscribe<messages::msg::Imu>(kReliableImu, [](const messages::msg::Imu&) {});

  EXPECT_TRUE(is_logged({"rt/kl1/imu: 'talker' (",
                         ") is not received, their QoS is incompatible: "
                         "reliability (offered best effort, requested reliable)"}))
      << all_lines();
  EXPECT_TRUE(is_logged({"rt/kl1/imu: 'listener' (",
                         ") does not receive from this process, their QoS is incompatible: "
                         "reliability (offered best effort, requested reliable)"}))
      << all_lines();
  EXPECT_EQ(publisher.matched(), 0);
  EXPECT_EQ(subscription.matched(), 0);
}

TEST_F(QosConflictLog, IncludesALateSubscriber) {
  const auto publisher = talker_.publish(messages::topics::kActuatorCommand);
  ASSERT_TRUE(eventually([&] { return !listener_.topics_seen().empty(); }));
  const auto subscription = listener_.subscribe<messages::msg::ActuatorCommand>(
      {messages::topics::kActuatorCommand.name, messages::Qos::kRequest},
      [](const messages::msg::ActuatorCommand&) {});

  const std::string policies = "reliability (offered best effort, requested reliable)";
  EXPECT_TRUE(is_logged({"rt/kl1/actuator_command: 'talker' (", "is not received", policies})) << all_lines();
  EXPECT_TRUE(is_logged({"rt/kl1/actuator_command: 'listener' (", "does not receive", policies}))
      << all_lines();
}

TEST_F(QosConflictLog, OmitsEndpointsThatMatch) {
  const auto matching_writer = talker_.publish(messages::topics::kImu);
  const auto conflicting_writer = talker_.publish(messages::topics::kMocapPose);
  const auto matching_reader =
      listener_.subscribe<messages::msg::Imu>(messages::topics::kImu, [](const messages::msg::Imu&) {});
  const auto conflicting_reader = listener_.subscribe<messages::msg::MocapPose>(
      {"mocap_pose", messages::Qos::kRequest}, [](const messages::msg::MocapPose&) {});

  ASSERT_TRUE(eventually([&] { return matching_writer.matched() == 1 && matching_reader.matched() == 1; }));
  ASSERT_TRUE(is_logged({"rt/kl1/mocap_pose", "is not received"})) << all_lines();
  EXPECT_EQ(count(lines_.items(), {"rt/kl1/imu"}), 0) << all_lines();
}

}  // namespace swiftlet::dds::qos_conflicts_test
