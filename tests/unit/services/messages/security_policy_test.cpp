// Who may write what under DDS Security.
#include "swiftlet/services/messages/security_policy.hpp"

#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "swiftlet/services/messages/topics.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::messages::security_policy_test {

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// "| `imu` | `Imu` | vehicle -> control | ..." of idl/README.md, which a test compares with topic_table.hpp.
std::map<std::string, std::string> documented_writers() {
  std::map<std::string, std::string> writers;
  std::ifstream file(tests::in_source("idl/README.md"));
  const std::regex row(R"(^\| `(\w+)` \| `\w+` \| (.*) -> .*)");
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    if (std::regex_match(line, match, row)) writers[match[1]] = match[2];
  }
  return writers;
}

TEST(TopicRoles, AreThoseOfTheDocumentation) {
  auto documented = documented_writers();
  EXPECT_GT(documented.size(), 20U);
  std::set<std::string> with_role;
  for_each_topic([&](const auto& topic) {
    ASSERT_EQ(documented.count(topic.name), 1U) << topic.name;
    for (const std::string_view writer : topic.writers) {
      if (writer.empty()) continue;
      EXPECT_TRUE(holds(documented[topic.name], std::string(writer)))
          << topic.name << ": " << documented[topic.name];
      with_role.insert(topic.name);
    }
  });
  for (const auto& [name, writer] : documented)
    EXPECT_EQ(with_role.count(name), 1U) << name << " has no role";
}

TEST(Permissions, AllowARoleItsTopicsOfItsVehicles) {
  const std::string control = permissions_document("control", "CN=control,O=Swiftlet", {"kl1", "kl2"});
  EXPECT_TRUE(holds(control, "<subject_name>CN=control,O=Swiftlet</subject_name>"));
  EXPECT_TRUE(holds(control, "<publish><topics><topic>rt/kl1/actuator_command</topic>"));
  EXPECT_TRUE(holds(control, "<topic>rt/kl2/control_status</topic>"));
  EXPECT_FALSE(holds(control, "<topic>rt/kl1/imu</topic>"));
  EXPECT_TRUE(holds(
      control, "<subscribe><topics><topic>rt/kl1/*</topic><topic>rt/kl2/*</topic></topics></subscribe>"));
  EXPECT_TRUE(holds(control, "<default>DENY</default>"));
  const std::string ground = permissions_document("ground", "CN=ground,O=Swiftlet", {"kl1"});
  EXPECT_FALSE(holds(ground, "actuator_command"));
  EXPECT_FALSE(holds(permissions_document("observer", "CN=observer,O=Swiftlet", {"kl1"}), "<publish>"));
}

}  // namespace swiftlet::messages::security_policy_test
