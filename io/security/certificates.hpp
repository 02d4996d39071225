// Certificates, signed documents and lists of revoked certificates for DDS Security, with OpenSSL: ECDSA on P-256 with
// SHA-256 (DDS Security 1.1, 9.3).
#pragma once

#include <optional>
#include <string>

namespace swiftlet::io {

// A certificate and its key, both in PEM.
struct Credential {
  std::string certificate;
  std::string private_key;
};

// The subject is "CN=common_name,O=Swiftlet". All of these throw std::runtime_error with what failed.
Credential make_authority(const std::string& common_name, int days);
// For an identity: OpenSSL refuses documents that it signs. Ends with the authority at the latest.
Credential issue(const Credential& authority, const std::string& common_name, int days);

// The document as S/MIME with a detached signature (DDS Security 1.1, 9.4.1).
std::string sign(const Credential& authority, const std::string& document);
// The text of such a document, checked as Fast DDS 2.9 does; nothing if the authority has not signed it.
std::optional<std::string> signed_text(const std::string& document, const std::string& authority_certificate);

// An empty list of revoked certificates, in PEM. It ends with the authority.
std::string make_revocation_list(const Credential& authority);
std::string revoke(const Credential& authority, const std::string& list, const std::string& certificate);
bool is_revoked(const std::string& certificate, const std::string& revocation_list);

// Why a certificate is not valid now, such as "has expired on 2026-11-01"; empty if it is.
std::string fault_of_authority(const std::string& certificate);
// Why a certificate is not valid now. The authority and its list are valid.
std::string fault_of_certificate(const std::string& certificate, const std::string& authority_certificate,
                                 const std::string& revocation_list);

// Whether the authority has signed the certificate or the list. False also if they are something else.
bool is_issued_by(const std::string& certificate, const std::string& authority_certificate);
bool is_list_of(const std::string& revocation_list, const std::string& authority_certificate);
// Whether the private key is that of the certificate. False also if they are something else.
bool belongs(const std::string& private_key, const std::string& certificate);

// "2027-11-23"
std::string last_day_of(const std::string& certificate);
// In hexadecimal digits.
std::string serial_number_of(const std::string& certificate);
// "CN=control,O=Swiftlet" (RFC 2253)
std::string subject_name_of(const std::string& certificate);

}  // namespace swiftlet::io
