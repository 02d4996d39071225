#include "swiftlet/services/messages/security_policy.hpp"

#include <ctime>

#include <fmt/core.h>

#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::messages {
namespace {

constexpr std::time_t kDay_s = 24 * 3600;
constexpr std::time_t kValid_s = 3650 * kDay_s;

constexpr const char* kAllDomains = "<domains><id_range><min>0</min><max>232</max></id_range></domains>";

std::string time_text(std::time_t time) {
  std::tm parts{};
  gmtime_r(&time, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
  return text;
}

std::string criterion(const char* kind, const std::string& topics) {
  return fmt::format("<{0}><topics>{1}</topics></{0}>\n", kind, topics);
}

}  // namespace

std::string governance_document() {
  return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="omg_shared_ca_governance.xsd">
<domain_access_rules>
<domain_rule>
{}
<allow_unauthenticated_participants>false</allow_unauthenticated_participants>
<enable_join_access_control>true</enable_join_access_control>
<discovery_protection_kind>ENCRYPT</discovery_protection_kind>
<liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
<rtps_protection_kind>ENCRYPT</rtps_protection_kind>
<topic_access_rules>
<topic_rule>
<topic_expression>*</topic_expression>
<enable_discovery_protection>true</enable_discovery_protection>
<enable_liveliness_protection>false</enable_liveliness_protection>
<enable_read_access_control>true</enable_read_access_control>
<enable_write_access_control>true</enable_write_access_control>
<metadata_protection_kind>NONE</metadata_protection_kind>
<data_protection_kind>NONE</data_protection_kind>
</topic_rule>
</topic_access_rules>
</domain_rule>
</domain_access_rules>
</dds>
)",
                     kAllDomains);
}

std::string permissions_document(const std::string& role, const std::string& subject,
                                 const std::vector<std::string>& vehicles) {
  std::string written;
  std::string read;
  for (const std::string& vehicle : vehicles) {
    read += fmt::format("<topic>rt/{}/*</topic>", vehicle);
    for_each_topic([&](const auto& topic) {
      for (const std::string_view writer : topic.writers)
        if (writer == role) written += fmt::format("<topic>rt/{}/{}</topic>", vehicle, topic.name);
    });
  }
  const std::time_t now = std::time(nullptr);
  return fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="omg_shared_ca_permissions.xsd">
<permissions>
<grant name="{}">
<subject_name>{}</subject_name>
<validity><not_before>{}</not_before><not_after>{}</not_after></validity>
<allow_rule>
{}
{}{}</allow_rule>
<default>DENY</default>
</grant>
</permissions>
</dds>
)",
                     role, subject, time_text(now - kDay_s), time_text(now + kValid_s), kAllDomains,
                     written.empty() ? "" : criterion("publish", written), criterion("subscribe", read));
}

}  // namespace swiftlet::messages
