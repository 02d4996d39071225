// `./dev soak networks` without its limit of time, which a busy machine does not keep.
#include "tests/soak/address_change.hpp"

#include <gtest/gtest.h>

#include "tests/support/network/network_namespace.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

class AddressChanges : public testing::TestWithParam<std::size_t> {};

TEST_P(AddressChanges, Heal) {
  if (const std::string why = tests::HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  const AddressChange& change = address_changes()[GetParam()];
  SCOPED_TRACE(change.name);
  const tests::TemporaryFolder folder;
  const ChangeResult result = change_addresses(change, folder.path());
  EXPECT_EQ(result.fault, "") << result.log;
}

INSTANTIATE_TEST_SUITE_P(Table, AddressChanges, testing::Range(std::size_t{0}, address_changes().size()));

}  // namespace
}  // namespace swiftlet::soak
