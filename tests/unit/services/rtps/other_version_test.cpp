// Datagrams that a build with another version of Fast DDS has sent: tests/wire/README.md.
#include <fstream>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/services/rtps/check.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/rtps_message.hpp"

namespace swiftlet::rtps::other_version_test {

using swiftlet::tests::Bytes;

// By kind.
std::map<std::string, Bytes> recorded() {
  std::ifstream file(tests::in_source("tests/wire/fast_dds_3_datagrams.txt"));
  std::map<std::string, Bytes> datagrams;
  std::string kind;
  std::string hex;
  std::getline(file, hex);  // the comment
  while (file >> kind >> hex) {
    Bytes& bytes = datagrams[kind];
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
      bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return datagrams;
}

TEST(DatagramsOfFastDds3, PassTheCheck) {
  const std::map<std::string, Bytes> datagrams = recorded();
  ASSERT_EQ(datagrams.size(), 6U);
  for (const auto& [kind, bytes] : datagrams) {
    const CheckedDatagram checked = check_datagram(bytes.data(), bytes.size(), DatagramLimits());
    EXPECT_EQ(checked.fault, nullptr) << kind << ": " << checked.fault;
    EXPECT_EQ(checked.announces_itself, kind == "participant") << kind;
    EXPECT_EQ(checked.places.hidden.size(), 0U) << kind << " describes types";
    EXPECT_EQ(bytes.size() - checked.length, 60U) << kind << ": the statistics are not cut off";
  }
}

TEST(DatagramsOfFastDds3, AreRefusedWhenCutOff) {
  Bytes announcement = recorded().at("participant");
  announcement.resize(announcement.size() / 2);
  EXPECT_NE(check_datagram(announcement.data(), announcement.size(), DatagramLimits()).fault, nullptr);
}

}  // namespace swiftlet::rtps::other_version_test
