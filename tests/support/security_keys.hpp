// Keys of DDS Security for tests.
#pragma once

#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

#include "swiftlet/io/security/security_folder.hpp"
#include "swiftlet/services/messages/security_policy.hpp"
#include "swiftlet/services/messages/topic_roles.hpp"

namespace swiftlet::tests {

// Makes the folder, with all roles of one vehicle, for a day. Returns its path.
inline std::string make_security_keys(const std::filesystem::path& folder, const std::string& vehicle) {
  const auto permissions = [&](const std::string& role) {
    return messages::permissions_document(role, io::subject_of(role), {vehicle});
  };
  io::make_security_folder({folder}, {std::begin(messages::kRoles), std::end(messages::kRoles)},
                           {messages::governance_document(), permissions}, 1);
  return folder;
}

}  // namespace swiftlet::tests
