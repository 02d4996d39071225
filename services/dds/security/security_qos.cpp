#include "swiftlet/services/dds/security/security_qos.hpp"

#include <filesystem>
#include <stdexcept>

#include "swiftlet/io/security/security_folder.hpp"
#include "swiftlet/services/messages/topic_roles.hpp"

namespace swiftlet::dds {
namespace {

std::string uri(const std::filesystem::path& file) {
  return "file://" + std::filesystem::absolute(file).string();
}

}  // namespace

std::string security_role(const std::string& folder, const std::string& process) {
  if (process == "plant" || process == "microcontroller") return messages::roles::kVehicle;
  if (process == "check") return messages::roles::kControl;  // commands a vehicle that no controller flies
  for (const char* const role :
       {messages::roles::kVehicle, messages::roles::kMocap, messages::roles::kControl}) {
    if (process == role) return role;
  }
  return io::SecurityFolder{folder}.has(messages::roles::kGround) ? messages::roles::kGround
                                                                  : messages::roles::kObserver;
}

std::string fault_of_security(const std::string& folder, const std::string& process) {
  return io::fault_of_security_folder({folder}, security_role(folder, process));
}

void set_security(const std::string& folder, const std::string& process,
                  eprosima::fastdds::dds::DomainParticipantQos& qos) {
  const std::string fault = fault_of_security(folder, process);
  if (!fault.empty()) throw std::runtime_error(fault);
  const io::SecurityFolder files{folder};
  const std::string role = security_role(folder, process);
  auto& properties = qos.properties().properties();
  const auto set = [&](const std::string& name, const std::string& value) {
    properties.emplace_back(name, value);
  };
  const std::string authentication = "dds.sec.auth.builtin.PKI-DH.";
  set("dds.sec.auth.plugin", "builtin.PKI-DH");
  set(authentication + "identity_ca", uri(files.authority()));
  set(authentication + "identity_certificate", uri(files.certificate(role)));
  set(authentication + "identity_crl", uri(files.revoked()));
  set(authentication + "private_key", uri(files.private_key(role)));
  const std::string access = "dds.sec.access.builtin.Access-Permissions.";
  set("dds.sec.access.plugin", "builtin.Access-Permissions");
  set(access + "permissions_ca", uri(files.authority()));
  set(access + "governance", uri(files.governance()));
  set(access + "permissions", uri(files.permissions(role)));
  set("dds.sec.crypto.plugin", "builtin.AES-GCM-GMAC");
}

}  // namespace swiftlet::dds
