#include "swiftlet/io/security/certificates.hpp"

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <memory>
#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <stdexcept>

namespace swiftlet::io {
namespace {

template <auto kFree>
struct FreeBy {
  template <class T>
  void operator()(T* object) const {
    kFree(object);
  }
};
using Bio = std::unique_ptr<BIO, FreeBy<BIO_free_all>>;
using Number = std::unique_ptr<BIGNUM, FreeBy<BN_free>>;
using Key = std::unique_ptr<EVP_PKEY, FreeBy<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, FreeBy<X509_free>>;
using Revocations = std::unique_ptr<X509_CRL, FreeBy<X509_CRL_free>>;
using Store = std::unique_ptr<X509_STORE, FreeBy<X509_STORE_free>>;
using StoreContext = std::unique_ptr<X509_STORE_CTX, FreeBy<X509_STORE_CTX_free>>;
using Signature = std::unique_ptr<PKCS7, FreeBy<PKCS7_free>>;
using Time = std::unique_ptr<ASN1_TIME, FreeBy<ASN1_TIME_free>>;
using Extension = std::unique_ptr<X509_EXTENSION, FreeBy<X509_EXTENSION_free>>;

constexpr long kClocksDiffer_s = 3600L;  // a certificate is valid from this long before it was made
constexpr int kSerialBits = 127;
constexpr const char* kNoCertificate = "is not a certificate";

[[noreturn]] void fail(const char* what) {
  char reason[256];
  ERR_error_string_n(ERR_get_error(), reason, sizeof reason);
  throw std::runtime_error(std::string("cannot ") + what + ": " + reason);
}

// Throws unless OpenSSL has done it.
void require(bool done, const char* what) {
  if (!done) fail(what);
}

Bio memory() {
  Bio bio(BIO_new(BIO_s_mem()));
  require(bio != nullptr, "allocate memory");
  return bio;
}
Bio reader_of(const std::string& text) {
  Bio bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
  require(bio != nullptr, "allocate memory");
  return bio;
}
std::string text_of(const Bio& bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

// These return null if the text is something else.
Certificate find_certificate(const std::string& pem) {
  return Certificate(PEM_read_bio_X509(reader_of(pem).get(), nullptr, nullptr, nullptr));
}
Key find_key(const std::string& pem) {
  char no_password[] = "";  // without one, OpenSSL asks the terminal
  return Key(PEM_read_bio_PrivateKey(reader_of(pem).get(), nullptr, nullptr, no_password));
}
Revocations find_revocations(const std::string& pem) {
  return Revocations(PEM_read_bio_X509_CRL(reader_of(pem).get(), nullptr, nullptr, nullptr));
}

Certificate certificate_of(const std::string& pem) {
  Certificate certificate = find_certificate(pem);
  require(certificate != nullptr, "read a certificate");
  return certificate;
}
Key key_of(const std::string& pem) {
  Key key = find_key(pem);
  require(key != nullptr, "read a private key");
  return key;
}
Revocations revocations_of(const std::string& pem) {
  Revocations list = find_revocations(pem);
  require(list != nullptr, "read a list of revoked certificates");
  return list;
}

std::string pem_of(X509* certificate) {
  const Bio out = memory();
  require(PEM_write_bio_X509(out.get(), certificate) == 1, "write a certificate");
  return text_of(out);
}
std::string pem_of(EVP_PKEY* key) {
  const Bio out = memory();
  require(PEM_write_bio_PrivateKey(out.get(), key, nullptr, nullptr, 0, nullptr, nullptr) == 1,
          "write a private key");
  return text_of(out);
}
std::string pem_of(X509_CRL* list) {
  const Bio out = memory();
  require(PEM_write_bio_X509_CRL(out.get(), list) == 1, "write a list of revoked certificates");
  return text_of(out);
}

void set_name(X509_NAME* name, const std::string& common_name) {
  const auto add = [&](const char* field, const std::string& value) {
    require(X509_NAME_add_entry_by_txt(name, field, MBSTRING_UTF8,
                                       reinterpret_cast<const unsigned char*>(value.data()),
                                       static_cast<int>(value.size()), -1, 0) == 1,
            "name a certificate");
  };
  add("O", "Swiftlet");
  add("CN", common_name);
}

void add_extension(X509* certificate, X509* issuer, int kind, const char* value) {
  X509V3_CTX context{};
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  const Extension extension(X509V3_EXT_conf_nid(nullptr, &context, kind, value));
  require(extension != nullptr && X509_add_ext(certificate, extension.get(), -1) == 1,
          "extend a certificate");
}

// Unsigned. issuer: null for an authority.
Certificate new_certificate(EVP_PKEY* key, const std::string& common_name, int days, X509* issuer) {
  Certificate certificate(X509_new());
  require(certificate != nullptr, "make a certificate");
  X509* const x = certificate.get();
  const Number serial(BN_new());
  require(serial != nullptr && BN_rand(serial.get(), kSerialBits, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY) == 1 &&
              BN_to_ASN1_INTEGER(serial.get(), X509_get_serialNumber(x)) != nullptr,
          "draw a serial number");
  require(X509_set_version(x, 2) == 1 &&
              X509_gmtime_adj(X509_getm_notBefore(x), -kClocksDiffer_s) != nullptr &&
              X509_time_adj_ex(X509_getm_notAfter(x), days, 0, nullptr) != nullptr &&
              X509_set_pubkey(x, key) == 1,
          "make a certificate");
  set_name(X509_get_subject_name(x), common_name);
  require(X509_set_issuer_name(x, X509_get_subject_name(issuer == nullptr ? x : issuer)) == 1,
          "make a certificate");
  add_extension(x, issuer == nullptr ? x : issuer, NID_subject_key_identifier, "hash");
  return certificate;
}

// A certificate is not valid for longer than its authority.
void limit_end(X509* certificate, const X509* authority) {
  const ASN1_TIME* const end = X509_get0_notAfter(authority);
  if (ASN1_TIME_compare(X509_get0_notAfter(certificate), end) > 0)
    require(X509_set1_notAfter(certificate, end) == 1, "make a certificate");
}

Key new_key() {
  Key key(EVP_PKEY_Q_keygen(nullptr, nullptr, "EC", "P-256"));
  require(key != nullptr, "make a private key");
  return key;
}

}  // namespace

Credential make_authority(const std::string& common_name, int days) {
  const Key key = new_key();
  const Certificate certificate = new_certificate(key.get(), common_name, days, nullptr);
  add_extension(certificate.get(), certificate.get(), NID_basic_constraints, "critical,CA:TRUE");
  add_extension(certificate.get(), certificate.get(), NID_key_usage,
                "critical,keyCertSign,cRLSign,digitalSignature");
  require(X509_sign(certificate.get(), key.get(), EVP_sha256()) != 0, "sign a certificate");
  return {pem_of(certificate.get()), pem_of(key.get())};
}

Credential issue(const Credential& authority, const std::string& common_name, int days) {
  const Certificate issuer = certificate_of(authority.certificate);
  const Key issuer_key = key_of(authority.private_key);
  const Key key = new_key();
  const Certificate certificate = new_certificate(key.get(), common_name, days, issuer.get());
  limit_end(certificate.get(), issuer.get());
  add_extension(certificate.get(), issuer.get(), NID_basic_constraints, "critical,CA:FALSE");
  add_extension(certificate.get(), issuer.get(), NID_key_usage, "critical,digitalSignature");
  // Without emailProtection, OpenSSL refuses it as the signer of S/MIME: Fast DDS 2.9 takes every other certificate of the
  // authority for a signer of permissions.
  add_extension(certificate.get(), issuer.get(), NID_ext_key_usage, "critical,clientAuth,serverAuth");
  require(X509_sign(certificate.get(), issuer_key.get(), EVP_sha256()) != 0, "sign a certificate");
  return {pem_of(certificate.get()), pem_of(key.get())};
}

std::string sign(const Credential& authority, const std::string& document) {
  constexpr int kFlags = PKCS7_TEXT | PKCS7_DETACHED | PKCS7_STREAM;
  const Certificate certificate = certificate_of(authority.certificate);
  const Key key = key_of(authority.private_key);
  const Bio in = reader_of(document);
  const Signature signature(PKCS7_sign(certificate.get(), key.get(), nullptr, in.get(), kFlags));
  require(signature != nullptr, "sign a document");
  const Bio out = memory();
  require(SMIME_write_PKCS7(out.get(), signature.get(), in.get(), kFlags) == 1, "sign a document");
  return text_of(out);
}

namespace {

std::string signed_list(X509_CRL* list, const Credential& authority) {
  const Certificate issuer = certificate_of(authority.certificate);
  const Key key = key_of(authority.private_key);
  const Time now(X509_gmtime_adj(nullptr, -kClocksDiffer_s));
  require(X509_CRL_set_version(list, 1) == 1 &&
              X509_CRL_set_issuer_name(list, X509_get_subject_name(issuer.get())) == 1 &&
              X509_CRL_set1_lastUpdate(list, now.get()) == 1 &&
              X509_CRL_set1_nextUpdate(list, X509_get0_notAfter(issuer.get())) == 1 &&
              X509_CRL_sort(list) == 1 && X509_CRL_sign(list, key.get(), EVP_sha256()) != 0,
          "sign a list of revoked certificates");
  return pem_of(list);
}

}  // namespace

std::string make_revocation_list(const Credential& authority) {
  const Revocations list(X509_CRL_new());
  require(list != nullptr, "make a list of revoked certificates");
  return signed_list(list.get(), authority);
}

std::string revoke(const Credential& authority, const std::string& list, const std::string& certificate) {
  const Revocations revocations = revocations_of(list);
  const Certificate revoked = certificate_of(certificate);
  const Time now(X509_gmtime_adj(nullptr, 0));
  X509_REVOKED* const entry = X509_REVOKED_new();
  require(entry != nullptr &&
              X509_REVOKED_set_serialNumber(entry, X509_get_serialNumber(revoked.get())) == 1 &&
              X509_REVOKED_set_revocationDate(entry, now.get()) == 1 &&
              X509_CRL_add0_revoked(revocations.get(), entry) == 1,
          "revoke a certificate");
  return signed_list(revocations.get(), authority);
}

namespace {

std::string last_day_of(const X509* certificate) {
  std::tm time{};
  require(ASN1_TIME_to_tm(X509_get0_notAfter(certificate), &time) == 1, "read a time");
  char day[16];
  std::strftime(day, sizeof day, "%Y-%m-%d", &time);
  return day;
}

Store store_of(X509* authority) {
  Store store(X509_STORE_new());
  require(store != nullptr && X509_STORE_add_cert(store.get(), authority) == 1, "check a certificate");
  return store;
}

// As Fast DDS checks identities: for no purpose in particular.
std::string fault_of(X509* certificate, X509_STORE* store) {
  const StoreContext context(X509_STORE_CTX_new());
  require(context != nullptr && X509_STORE_CTX_init(context.get(), store, certificate, nullptr) == 1,
          "check a certificate");
  if (X509_verify_cert(context.get()) == 1) return {};
  ERR_clear_error();
  const int error = X509_STORE_CTX_get_error(context.get());
  if (error == X509_V_ERR_CERT_HAS_EXPIRED) return "has expired on " + last_day_of(certificate);
  if (error == X509_V_ERR_CERT_NOT_YET_VALID) return "is not valid yet; is the clock of this host right?";
  if (error == X509_V_ERR_CERT_REVOKED) return "is revoked";
  return std::string("is not valid: ") + X509_verify_cert_error_string(error);
}

}  // namespace

std::string last_day_of(const std::string& certificate) {
  return last_day_of(certificate_of(certificate).get());
}

std::string serial_number_of(const std::string& certificate) {
  const Bio out = memory();
  require(i2a_ASN1_INTEGER(out.get(), X509_get0_serialNumber(certificate_of(certificate).get())) > 0,
          "read a serial number");
  return text_of(out);
}

std::string subject_name_of(const std::string& certificate) {
  const Bio out = memory();
  require(X509_NAME_print_ex(out.get(), X509_get_subject_name(certificate_of(certificate).get()), 0,
                             XN_FLAG_RFC2253 & ~ASN1_STRFLGS_ESC_MSB) > 0,
          "read a name");
  return text_of(out);
}

std::string fault_of_authority(const std::string& certificate) {
  const Certificate authority = find_certificate(certificate);
  if (authority == nullptr) return kNoCertificate;
  return fault_of(authority.get(), store_of(authority.get()).get());
}

std::string fault_of_certificate(const std::string& certificate, const std::string& authority_certificate,
                                 const std::string& revocation_list) {
  const Certificate tested = find_certificate(certificate);
  if (tested == nullptr) return kNoCertificate;
  const Store store = store_of(certificate_of(authority_certificate).get());
  require(X509_STORE_add_crl(store.get(), revocations_of(revocation_list).get()) == 1 &&
              X509_STORE_set_flags(store.get(), X509_V_FLAG_CRL_CHECK) == 1,
          "check a certificate");
  return fault_of(tested.get(), store.get());
}

bool is_issued_by(const std::string& certificate, const std::string& authority_certificate) {
  const Certificate issued = find_certificate(certificate);
  const Certificate authority = certificate_of(authority_certificate);
  const bool by_authority =
      issued != nullptr && X509_verify(issued.get(), X509_get0_pubkey(authority.get())) == 1;
  ERR_clear_error();
  return by_authority;
}

bool is_list_of(const std::string& revocation_list, const std::string& authority_certificate) {
  const Revocations list = find_revocations(revocation_list);
  const Certificate authority = certificate_of(authority_certificate);
  const bool by_authority =
      list != nullptr && X509_CRL_verify(list.get(), X509_get0_pubkey(authority.get())) == 1;
  ERR_clear_error();
  return by_authority;
}

bool is_revoked(const std::string& certificate, const std::string& revocation_list) {
  X509_REVOKED* entry = nullptr;
  return X509_CRL_get0_by_cert(revocations_of(revocation_list).get(), &entry,
                               certificate_of(certificate).get()) == 1;
}

bool belongs(const std::string& private_key, const std::string& certificate) {
  const Certificate of = find_certificate(certificate);
  const Key key = find_key(private_key);
  const bool same = of != nullptr && key != nullptr && X509_check_private_key(of.get(), key.get()) == 1;
  ERR_clear_error();
  return same;
}

std::optional<std::string> signed_text(const std::string& document,
                                       const std::string& authority_certificate) {
  const Store store = store_of(certificate_of(authority_certificate).get());
  BIO* content = nullptr;
  const Signature signature(SMIME_read_PKCS7(reader_of(document).get(), &content));
  const Bio owned_content(content);
  const Bio out = memory();
  const bool valid = signature != nullptr &&
                     PKCS7_verify(signature.get(), nullptr, store.get(), content, out.get(), PKCS7_TEXT) == 1;
  ERR_clear_error();
  if (!valid) return std::nullopt;
  return text_of(out);
}

}  // namespace swiftlet::io
