#include "swiftlet/io/security/security_folder.hpp"

#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <sys/stat.h>
#include <system_error>

#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/owner_only.hpp"
#include "swiftlet/io/security/certificates.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::runtime {
namespace {

namespace fs = std::filesystem;

constexpr int kAuthorityDays = 3650;
constexpr std::size_t kLargestFile = 1 << 20;  // bytes

std::string read(const fs::path& file) { return read_text_file(file, kLargestFile); }

Credential authority_of(const SecurityFolder& folder) {
  require_owner_only(folder.authority_key());
  return {read(folder.authority()), read(folder.authority_key())};
}

void write_identity(const SecurityFolder& folder, const std::string& role, const Credential& identity) {
  write_atomically(folder.certificate(role), identity.certificate);
  write_for_owner_only(folder.private_key(role), identity.private_key);
}

void fill(const SecurityFolder& folder, const std::vector<std::string>& roles,
          const SecurityDocuments& documents, int days) {
  const Credential authority = make_authority("authority", kAuthorityDays);
  write_for_owner_only(folder.authority_key(), authority.private_key);
  write_atomically(folder.authority(), authority.certificate);
  write_atomically(folder.revoked(), make_revocation_list(authority));
  write_atomically(folder.governance(), sign(authority, documents.governance));
  for (const std::string& role : roles) {
    fs::create_directory(folder.path / role);
    write_identity(folder, role, issue(authority, role, days));
    write_atomically(folder.permissions(role), sign(authority, documents.permissions(role)));
  }
}

}  // namespace

std::string subject_of(const std::string& role) { return "CN=" + role + ",O=Swiftlet"; }

void make_security_folder(const SecurityFolder& folder, const std::vector<std::string>& roles,
                          const SecurityDocuments& documents, int days) {
  if (fs::exists(folder.path)) throw std::runtime_error(folder.path.string() + " exists");
  const SecurityFolder unfinished{unfinished_name(folder.path)};
  fs::remove_all(unfinished.path);
  try {
    fs::create_directories(unfinished.path);
    fs::permissions(unfinished.path, fs::perms::owner_all);
    fill(unfinished, roles, documents, days);
    fs::rename(unfinished.path, folder.path);
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(unfinished.path, ignored);
    throw;
  }
}

void renew_identity(const SecurityFolder& folder, const std::string& role, int days) {
  if (!fs::exists(folder.permissions(role)))
    throw std::runtime_error(folder.permissions(role).string() + " is missing: the folder has no role " +
                             role);
  write_identity(folder, role, issue(authority_of(folder), role, days));
}

void revoke_identity(const SecurityFolder& folder, const fs::path& certificate) {
  const std::string revoked = read(certificate);
  const std::string list = read(folder.revoked());
  const std::string fault = fault_of_certificate(revoked, read(folder.authority()), list);
  if (!fault.empty()) throw std::runtime_error(certificate.string() + " " + fault);
  write_atomically(folder.revoked(), revoke(authority_of(folder), list, revoked));
}

std::string fault_of_security_folder(const SecurityFolder& folder, const std::string& role) {
  try {
    const std::string certificate = read(folder.certificate(role));
    require_owner_only(folder.private_key(role));
    const std::string fault =
        fault_of_certificate(certificate, read(folder.authority()), read(folder.revoked()));
    if (!fault.empty()) return folder.certificate(role).string() + " " + fault;
    if (!belongs(read(folder.private_key(role)), certificate))
      return folder.private_key(role).string() + " is not the key of " + folder.certificate(role).string();
    for (const fs::path& file : {folder.governance(), folder.permissions(role)}) {
      if (!fs::exists(file)) return file.string() + " is missing";
    }
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

}  // namespace swiftlet::runtime
