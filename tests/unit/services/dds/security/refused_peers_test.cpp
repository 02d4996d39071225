// Who is refused, and the reason that Fast DDS logs for it.
#include "swiftlet/services/dds/security/refused_peers.hpp"

#include <chrono>
#include <string>

#include <fastdds/dds/log/Log.hpp>
#include <gtest/gtest.h>

#include "swiftlet/services/dds/dds_profile.hpp"
#include "tests/support/log_text.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::comms::refused_peers_test {

class RefusedPeersTest : public testing::Test {
 protected:
  // As Fast DDS does: the reason, if it has one, and then the refusal, in one thread.
  void refuse(const std::string& peer, const std::string& logged_reason, const char* given_reason = "") {
    if (!logged_reason.empty()) EPROSIMA_LOG_WARNING(SECURITY_AUTHENTICATION, logged_reason);
    RefusedPeers::Guid guid;
    guid.guidPrefix.value[0] = ++guids_;
    peers_.note(guid, peer, given_reason, now_);
  }
  std::string lines() {
    eprosima::fastdds::dds::Log::Flush();
    peers_.write_due(now_ + RefusedPeers::kReasonTime);
    return text_.lines();
  }

  static constexpr const char* kExpired = "Invalidation error of certificate  (certificate has expired)";

 private:
  tests::LogText text_;
  static inline std::uint8_t guids_ = 0;  // the log keeps the reasons of all tests
  const RefusedPeers::Time now_ = std::chrono::steady_clock::now();
  RefusedPeers peers_;
};

TEST_F(RefusedPeersTest, EachGetsItsOwnReason) {
  refuse("late", kExpired);
  refuse("nameless", "");
  refuse("silent", "", ": it does not complete the handshake");
  refuse("foreign", "Invalidation error of certificate  (unable to get local issuer certificate)");
  EXPECT_EQ(lines(),
            "refused late: its certificate has expired\n"
            "refused nameless\n"
            "refused silent: it does not complete the handshake\n"
            "refused foreign: unable to get local issuer certificate\n");
}

TEST_F(RefusedPeersTest, OtherReasonsAreQuoted) {
  refuse("forger", "Signature verification error (4711)");
  EXPECT_EQ(lines(), "refused forger: Signature verification error (4711)\n");
}

TEST_F(RefusedPeersTest, ErrorsGoToStderr) {
  testing::internal::CaptureStderr();
  EPROSIMA_LOG_ERROR(SECURITY_AUTHENTICATION, "Cannot generate EVP key");
  refuse("peer", "");
  EXPECT_EQ(lines(), "refused peer\n");
  EXPECT_NE(testing::internal::GetCapturedStderr().find("Cannot generate EVP key"), std::string::npos);
}

TEST_F(RefusedPeersTest, ReasonsAreKnownAfterAProfileWasLoaded) {
  const swiftlet::tests::TemporaryFolder folder;
  load_dds_profile(
      folder.write("p.xml",
                   "<dds><profiles><participant profile_name=\"sized\"><rtps><sendSocketBufferSize>70000"
                   "</sendSocketBufferSize></rtps></participant></profiles></dds>\n"));
  refuse("late", kExpired);
  EXPECT_EQ(lines(), "refused late: its certificate has expired\n");
}

}  // namespace swiftlet::comms::refused_peers_test
