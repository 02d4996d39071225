// The rules that a datagram breaks if its sender has another key than this process, and what to do about each.
#pragma once

namespace swiftlet::rtps {

inline constexpr char kNotSealed[] = "not sealed with a network key";
inline constexpr char kOtherKey[] = "sealed with another network key";
inline constexpr char kNoKey[] = "sealed with a network key, and this process has none";
inline constexpr char kOtherTime[] =
    "sealed more than 30 s ago or ahead: a recording, or the clocks of the hosts differ";
inline constexpr char kNotEncrypted[] = "submessage that is not encrypted (DDS Security 7.3.6)";
inline constexpr char kDataNotEncrypted[] = "DATA that is not encrypted (DDS Security 7.4)";
inline constexpr char kEncrypted[] = "encrypted submessage, but security is off (DDS Security 7.3.6)";
inline constexpr char kSecurityData[] = "DATA of DDS Security, but security is off (DDS Security 7.4)";
inline constexpr char kSecurityToken[] = "security token, but security is off (DDS Security 7.2.4)";

// "give this process ..."; nullptr for any other rule.
const char* remedy_of(const char* rule);

}  // namespace swiftlet::rtps
