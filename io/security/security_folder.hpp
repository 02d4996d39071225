// The folder of keys, certificates and permissions of a network with DDS Security:
//
//   ca.key                      private key of the authority: only where keys are made
//   ca.pem, revoked.pem         its certificate, and the list of revoked ones
//   governance.p7s              what is encrypted, and who may join
//   ROLE/certificate.pem, ROLE/private.key, ROLE/permissions.p7s     of each role
//
// A process needs all of them but ca.key, and of the folders only that of its role.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace swiftlet::runtime {

struct SecurityFolder {
  std::filesystem::path path;

  std::filesystem::path authority_key() const { return path / "ca.key"; }
  std::filesystem::path authority() const { return path / "ca.pem"; }
  std::filesystem::path revoked() const { return path / "revoked.pem"; }
  std::filesystem::path governance() const { return path / "governance.p7s"; }
  std::filesystem::path certificate(const std::string& role) const { return path / role / "certificate.pem"; }
  std::filesystem::path private_key(const std::string& role) const { return path / role / "private.key"; }
  std::filesystem::path permissions(const std::string& role) const { return path / role / "permissions.p7s"; }
  bool has(const std::string& role) const { return std::filesystem::exists(path / role); }
};

// The subject of a role's certificate, as permissions name it (RFC 2253).
std::string subject_of(const std::string& role);

struct SecurityDocuments {
  std::string governance;                                           // XML
  std::function<std::string(const std::string& role)> permissions;  // XML
};

// Makes the folder with an authority and an identity of each role, as a whole. days: until the certificates of the roles
// expire. Throws std::runtime_error if it exists or cannot be written.
void make_security_folder(const SecurityFolder& folder, const std::vector<std::string>& roles,
                          const SecurityDocuments& documents, int days);

// Issues a new certificate and private key for the role; the old one stays valid. Throws std::runtime_error.
void renew_identity(const SecurityFolder& folder, const std::string& role, int days);

// Adds the certificate to the revoked ones. Throws std::runtime_error, also if it is revoked already.
void revoke_identity(const SecurityFolder& folder, const std::filesystem::path& certificate);

// Why a process of this role cannot join with the folder, a sentence that names the file; empty if it can.
std::string fault_of_security_folder(const SecurityFolder& folder, const std::string& role);

}  // namespace swiftlet::runtime
