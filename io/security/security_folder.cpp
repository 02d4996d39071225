#include "swiftlet/io/security/security_folder.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <stdexcept>

#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/owner_only.hpp"
#include "swiftlet/io/security/certificates.hpp"
#include "swiftlet/io/temporary_folder.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::io {
namespace {

namespace fs = std::filesystem;

constexpr int kAuthorityDays = 3650;
constexpr std::size_t kLargestSecurityFile = 1 << 20;  // bytes

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + " " + why);
}

std::string read(const fs::path& file) { return read_text_file(file, kLargestSecurityFile); }

bool is_there(const fs::path& file) {
  std::error_code fault;
  const bool found = fs::exists(file, fault);
  if (fault) throw ConfigError(file, 0, "", "cannot be read: " + fault.message());
  return found;
}

void make_folders(const fs::path& path) {
  std::error_code fault;
  fs::create_directories(path, fault);
  if (fault) throw std::runtime_error(write_fault(path, fault.value()));
}

// "lab" for "lab/"
fs::path without_trailing_slash(const fs::path& path) {
  const fs::path normal = path.lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

std::string without_spaces(std::string text) {
  const auto is_space = [](unsigned char c) { return std::isspace(c) != 0; };
  text.erase(std::remove_if(text.begin(), text.end(), is_space), text.end());
  return text;
}

// What reads or requires something valid or signed throws std::runtime_error for a file with a fault.

std::string read_valid_authority(const SecurityFolder& folder) {
  std::string authority = read(folder.authority());
  const std::string fault = fault_of_authority(authority);
  if (!fault.empty()) refuse(folder.authority(), fault);
  return authority;
}

Credential read_valid_authority_with_key(const SecurityFolder& folder) {
  require_owner_only(folder.authority_key());
  Credential authority{read_valid_authority(folder), read(folder.authority_key())};
  if (!belongs(authority.private_key, authority.certificate))
    refuse(folder.authority_key(), "is not the key of " + folder.authority().string());
  return authority;
}

std::string read_valid_revocations(const SecurityFolder& folder, const std::string& authority) {
  std::string list = read(folder.revoked());
  if (!is_list_of(list, authority))
    refuse(folder.revoked(), "is not the list of revoked certificates of " + folder.authority().string());
  return list;
}

std::string read_signed(const SecurityFolder& folder, const fs::path& document,
                        const std::string& authority) {
  const std::optional<std::string> text = signed_text(read(document), authority);
  if (!text) refuse(document, "is not signed by " + folder.authority().string());
  return *text;
}

void require_valid_identity(const SecurityFolder& folder, const std::string& role) {
  const fs::path file = folder.certificate(role);
  const std::string certificate = read(file);
  require_owner_only(folder.private_key(role));
  const std::string authority = read_valid_authority(folder);
  const std::string fault =
      fault_of_certificate(certificate, authority, read_valid_revocations(folder, authority));
  if (!fault.empty()) refuse(file, fault);
  if (!belongs(read(folder.private_key(role)), certificate))
    refuse(folder.private_key(role), "is not the key of " + file.string());

  read_signed(folder, folder.governance(), authority);
  const std::string permissions = read_signed(folder, folder.permissions(role), authority);
  const std::string subject = subject_name_of(certificate);
  const std::string element = without_spaces("<subject_name>" + subject + "</subject_name>");
  if (without_spaces(permissions).find(element) == std::string::npos)
    refuse(folder.permissions(role), "is not for " + subject + ", the subject of " + file.string());
}

// Records the certificate as issued, and writes both files before either gets its name.
void write_identity(const SecurityFolder& folder, const std::string& role, const Credential& identity) {
  make_folders(folder.issued(role));
  write_atomically(folder.issued(role) / (serial_number_of(identity.certificate) + ".pem"),
                   identity.certificate);
  const fs::path unfinished_key = unfinished_name(folder.private_key(role));
  write_unfinished_for_owner_only(folder.private_key(role), identity.private_key);
  try {
    write_atomically(folder.certificate(role), identity.certificate);
    finish_file(folder.private_key(role));
  } catch (const std::runtime_error&) {
    std::error_code ignored;
    fs::remove(unfinished_key, ignored);
    throw;
  }
}

void fill(const SecurityFolder& folder, const std::vector<std::string>& roles,
          const SecurityDocuments& documents, int days) {
  const Credential authority = make_authority("authority", kAuthorityDays);
  write_for_owner_only(folder.authority_key(), authority.private_key);
  write_atomically(folder.authority(), authority.certificate);
  write_atomically(folder.revoked(), make_revocation_list(authority));
  write_atomically(folder.governance(), sign(authority, documents.governance));
  for (const std::string& role : roles) {
    make_folders(folder.path / role);
    write_identity(folder, role, issue(authority, role, days));
    write_atomically(folder.permissions(role), sign(authority, documents.permissions(role)));
  }
}

// The one in use, and all that were issued.
std::vector<fs::path> certificates_of(const SecurityFolder& folder, const std::string& role) {
  std::vector<fs::path> files;
  if (is_there(folder.certificate(role))) files.push_back(folder.certificate(role));
  if (!is_there(folder.issued(role))) return files;
  std::error_code fault;
  for (fs::directory_iterator entry(folder.issued(role), fault), end; !fault && entry != end;
       entry.increment(fault)) {
    if (entry->path().extension() == ".pem") files.push_back(entry->path());
  }
  if (fault) throw ConfigError(folder.issued(role), 0, "", "cannot be read: " + fault.message());
  return files;
}

// Throws std::runtime_error unless there is one to revoke.
void revoke_certificates(const SecurityFolder& folder, const std::vector<fs::path>& files) {
  const Credential authority = read_valid_authority_with_key(folder);
  std::string list = read_valid_revocations(folder, authority.certificate);
  bool changed = false;
  for (const fs::path& file : files) {
    const std::string certificate = read(file);
    if (!is_issued_by(certificate, authority.certificate))
      refuse(file, "is not a certificate of " + folder.authority().string());
    if (is_revoked(certificate, list)) continue;
    list = revoke(authority, list, certificate);
    changed = true;
  }
  if (!changed) refuse(files.front(), "is revoked already");
  write_atomically(folder.revoked(), list);
}

}  // namespace

std::string subject_of(const std::string& role) { return "CN=" + role + ",O=Swiftlet"; }

void make_security_folder(const SecurityFolder& folder, const std::vector<std::string>& roles,
                          const SecurityDocuments& documents, int days) {
  const fs::path path = without_trailing_slash(folder.path);
  if (is_there(path)) refuse(path, "exists");
  if (path.has_parent_path()) make_folders(path.parent_path());
  TemporaryFolder unfinished(path);
  fill(SecurityFolder{unfinished.path()}, roles, documents, days);
  std::error_code fault;
  fs::rename(unfinished.path(), path, fault);
  if (fault) throw std::runtime_error(write_fault(path, fault.value()));
  unfinished.keep();
}

std::string renew_identity(const SecurityFolder& folder, const std::string& role, int days) {
  if (!is_there(folder.permissions(role)))
    refuse(folder.permissions(role), "is missing: the folder has no role " + role);
  const Credential authority = read_valid_authority_with_key(folder);
  const Credential identity = issue(authority, role, days);
  write_identity(folder, role, identity);
  const std::string last_day = last_day_of(identity.certificate);
  return last_day == last_day_of(authority.certificate) ? last_day + ", when its authority expires"
                                                        : last_day;
}

void revoke_role(const SecurityFolder& folder, const std::string& role) {
  const std::vector<fs::path> files = certificates_of(folder, role);
  if (files.empty()) refuse(folder.path, "has no certificate of the role " + role);
  revoke_certificates(folder, files);
}

void revoke_identity(const SecurityFolder& folder, const fs::path& certificate) {
  revoke_certificates(folder, {certificate});
}

std::string fault_of_security_folder(const SecurityFolder& folder, const std::string& role) {
  try {
    require_valid_identity(folder, role);
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

}  // namespace swiftlet::io
