// The folder of keys, certificates and permissions of a network with DDS Security:
//
//   ca.key                      private key of the authority: only where keys are made
//   ca.pem, revoked.pem         its certificate, and the list of revoked ones
//   governance.p7s              what is encrypted, and who may join
//   ROLE/certificate.pem, ROLE/private.key, ROLE/permissions.p7s     of each role
//   issued/ROLE/SERIAL.pem      all certificates that a role was given, which `swiftlet keys revoke` revokes
//
// A process needs ca.pem, revoked.pem, governance.p7s and the folder of its role.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <system_error>
#include <vector>

namespace swiftlet::io {

struct SecurityFolder {
  std::filesystem::path path;

  std::filesystem::path authority_key() const { return path / "ca.key"; }
  std::filesystem::path authority() const { return path / "ca.pem"; }
  std::filesystem::path revoked() const { return path / "revoked.pem"; }
  std::filesystem::path governance() const { return path / "governance.p7s"; }
  std::filesystem::path certificate(const std::string& role) const { return path / role / "certificate.pem"; }
  std::filesystem::path private_key(const std::string& role) const { return path / role / "private.key"; }
  std::filesystem::path permissions(const std::string& role) const { return path / role / "permissions.p7s"; }
  std::filesystem::path issued(const std::string& role) const { return path / "issued" / role; }
  // True also if that cannot be known, such as without the right to look: who reads the role's files then says why.
  bool has(const std::string& role) const {
    std::error_code ignored;
    return std::filesystem::status(path / role, ignored).type() != std::filesystem::file_type::not_found;
  }
};

// The subject of a role's certificate, as permissions name it (RFC 2253).
std::string subject_of(const std::string& role);

struct SecurityDocuments {
  std::string governance;                                           // XML
  std::function<std::string(const std::string& role)> permissions;  // XML
};

// Makes the folder with an authority and an identity of each role, as a whole. days: until the certificates of the roles
// expire, at the latest with the authority. Throws std::runtime_error if it exists or cannot be written.
void make_security_folder(const SecurityFolder& folder, const std::vector<std::string>& roles,
                          const SecurityDocuments& documents, int days);

// Issues a new certificate and private key for the role; the old one stays valid. Returns the last day of the new one, as
// "2027-11-23" or "2036-11-20, when its authority expires". Throws std::runtime_error; the old ones then remain.
std::string renew_identity(const SecurityFolder& folder, const std::string& role, int days);

// Revokes every certificate that was issued for the role. Throws std::runtime_error, also if all are revoked already.
void revoke_role(const SecurityFolder& folder, const std::string& role);
// Revokes one certificate, such as one that a copy of the folder has issued. Throws like revoke_role().
void revoke_identity(const SecurityFolder& folder, const std::filesystem::path& certificate);

// Why a process of this role cannot join with the folder, a sentence that names the file; empty if it can.
std::string fault_of_security_folder(const SecurityFolder& folder, const std::string& role);

}  // namespace swiftlet::io
