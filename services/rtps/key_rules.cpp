#include "swiftlet/services/rtps/key_rules.hpp"

#include <string_view>

namespace swiftlet::rtps {
namespace {

constexpr char kGiveNetworkKey[] =
    "give this process the key of those there (--network-key, SWIFTLET_NETWORK_KEY)";
constexpr char kGiveSecurity[] = "give this process keys as those there have (--security, SWIFTLET_SECURITY)";
constexpr char kStartWithSecurity[] = "start those there with keys too (--security), or this process without";

struct KeyRule {
  std::string_view rule;
  const char* remedy;
};
constexpr KeyRule kKeyRules[] = {
    {kNotSealed, "start those there with the same key (--network-key), or this process without"},
    {kOtherKey, kGiveNetworkKey},
    {kNoKey, kGiveNetworkKey},
    {kOtherTime, "a key needs clocks that agree: set those of both hosts"},
    {kNotEncrypted, kStartWithSecurity},
    {kDataNotEncrypted, kStartWithSecurity},
    {kEncrypted, kGiveSecurity},
    {kSecurityData, kGiveSecurity},
    {kSecurityToken, kGiveSecurity},
};

}  // namespace

const char* remedy_of(const char* rule) {
  for (const KeyRule& known : kKeyRules) {
    if (known.rule == rule) return known.remedy;
  }
  return nullptr;
}

}  // namespace swiftlet::rtps
