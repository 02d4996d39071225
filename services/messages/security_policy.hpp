// The documents of DDS Security 1.1 (9.4.1): what is protected, and which role writes which topics.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::messages {

// Only authenticated participants with permissions join. Every datagram is encrypted, but for the announcements by which
// participants find each other, and their handshakes.
std::string governance_document();

// The permissions of a role of topic_roles.hpp: it writes its topics of these vehicles, and reads all topics. subject: of its
// certificate. Valid for ten years from now: the certificate ends earlier.
std::string permissions_document(const std::string& role, const std::string& subject,
                                 const std::vector<std::string>& vehicles);

}  // namespace swiftlet::messages
