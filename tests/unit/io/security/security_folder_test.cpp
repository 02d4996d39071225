// Keys and certificates of DDS Security.
#include "swiftlet/io/security/security_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/security/certificates.hpp"
#include "swiftlet/io/text_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::io::security_folder_test {

namespace fs = std::filesystem;

const std::vector<std::string> kTwoRoles{"control", "ground"};

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

class SecurityFolderTest : public testing::Test {
 protected:
  SecurityFolder make(const std::string& name, int days = 30) const {
    SecurityFolder folder{temporary_.path() / name};
    make_security_folder(
        folder, kTwoRoles,
        {"<governance/>",
         [](const std::string& role) { return "<subject_name>" + subject_of(role) + "</subject_name>"; }},
        days);
    return folder;
  }
  // Without the names of folders.
  std::string fault(const SecurityFolder& folder, const std::string& role) const {
    return replaced(fault_of_security_folder(folder, role), temporary_.path().string() + "/", "");
  }

  static Credential authority_of(const SecurityFolder& folder) {
    return {read_text_file(folder.authority()), read_text_file(folder.authority_key())};
  }
  static Credential identity_of(const SecurityFolder& folder, const std::string& role) {
    return {read_text_file(folder.certificate(role)), read_text_file(folder.private_key(role))};
  }
  static bool is_revoked(const SecurityFolder& folder, const std::string& certificate) {
    return io::is_revoked(certificate, read_text_file(folder.revoked()));
  }
  // What the function throws, without the names of folders; "" if nothing.
  template <class Function>
  std::string refusal(const Function& function) const {
    try {
      function();
    } catch (const std::runtime_error& error) {
      return replaced(error.what(), temporary_.path().string() + "/", "");
    }
    return "";
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(temporary_.path()))
      names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  tests::TemporaryFolder temporary_;
};

TEST_F(SecurityFolderTest, EveryRoleCanJoin) {
  const SecurityFolder folder = make("lab");
  for (const std::string& role : kTwoRoles) EXPECT_EQ(fault(folder, role), "");
  const std::string permissions = read_text_file(folder.permissions("control"));
  EXPECT_EQ(permissions.find("MIME-Version: 1.0"), 0U);
  EXPECT_NE(permissions.find("<subject_name>CN=control,O=Swiftlet</subject_name>"), std::string::npos);
  EXPECT_NE(permissions.find("application/x-pkcs7-signature"), std::string::npos);
}

TEST_F(SecurityFolderTest, IsMadeAsAWhole) {
  const SecurityFolder folder = make("lab");
  EXPECT_THROW(make("lab"), std::runtime_error) << "it exists";
  EXPECT_THROW(make_security_folder(
                   {temporary_.path() / "half"}, kTwoRoles,
                   {"", [](const std::string&) -> std::string { throw std::runtime_error("no"); }}, 30),
               std::runtime_error);
  EXPECT_EQ(names(), std::vector<std::string>{"lab"});
}

TEST_F(SecurityFolderTest, MayBeNamedWithASlash) {
  make("lab/");
  EXPECT_EQ(fault({temporary_.path() / "lab"}, "control"), "");
  EXPECT_EQ(refusal([&] { make("lab/"); }), "lab exists");
  EXPECT_EQ(names(), std::vector<std::string>{"lab"});
}

TEST_F(SecurityFolderTest, LeavesOtherFoldersAlone) {
  const fs::path notes = temporary_.path() / "lab.part" / "notes.txt";
  fs::create_directory(notes.parent_path());
  std::ofstream(notes) << "mine";
  make("lab");
  EXPECT_EQ(read_text_file(notes), "mine");
  EXPECT_EQ(names(), (std::vector<std::string>{"lab", "lab.part"}));
}

// A link to itself stands for a folder of another user, which root can read.
TEST_F(SecurityFolderTest, SaysWhyItCannotBeRead) {
  fs::create_symlink("loop", temporary_.path() / "loop");
  const SecurityFolder folder{temporary_.path() / "loop"};
  const std::string cause = ": cannot be read: Too many levels of symbolic links";
  EXPECT_TRUE(folder.has("control")) << "for all that is known";
  EXPECT_EQ(fault(folder, "control"), "loop/control/certificate.pem" + cause);
  EXPECT_EQ(refusal([&] { make("loop"); }), "loop" + cause);
  EXPECT_EQ(refusal([&] { renew_identity(folder, "control", 30); }), "loop/control/permissions.p7s" + cause);
  EXPECT_EQ(refusal([&] { revoke_role(folder, "control"); }), "loop/control/certificate.pem" + cause);

  std::ofstream(temporary_.path() / "file") << "not a folder";
  EXPECT_EQ(refusal([&] { make("file/lab"); }), "file: cannot be written: Not a directory");
}

TEST_F(SecurityFolderTest, NamesWhatIsMissing) {
  const SecurityFolder folder = make("lab");
  EXPECT_EQ(fault(folder, "mocap"), "lab/mocap/certificate.pem: cannot be read: No such file or directory");
  fs::remove(folder.permissions("ground"));
  EXPECT_EQ(fault(folder, "ground"), "lab/ground/permissions.p7s: cannot be read: No such file or directory");
  EXPECT_THROW(renew_identity(folder, "ground", 30), std::runtime_error);
  EXPECT_EQ(refusal([&] { revoke_role(folder, "mocap"); }), "lab has no certificate of the role mocap");
}

TEST_F(SecurityFolderTest, OthersMayNotReadAPrivateKey) {
  const SecurityFolder folder = make("lab");
  EXPECT_EQ(fs::status(folder.authority_key()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  fs::permissions(folder.private_key("control"), fs::perms::group_read, fs::perm_options::add);
  EXPECT_EQ(fault(folder, "control"),
            "lab/control/private.key: has rights 0640, must be 0600: others could read the key");
}

TEST_F(SecurityFolderTest, RefusesExpiredForeignAndRevokedCertificates) {
  const SecurityFolder expired = make("old", -2);
  EXPECT_EQ(fault(expired, "control").rfind("old/control/certificate.pem has expired on 20", 0), 0U);

  const SecurityFolder folder = make("lab");
  const SecurityFolder other = make("other");
  fs::copy(other.certificate("control"), folder.certificate("control"), fs::copy_options::overwrite_existing);
  EXPECT_EQ(fault(folder, "control").rfind("lab/control/certificate.pem is not valid: ", 0), 0U);

  revoke_identity(folder, folder.certificate("ground"));
  EXPECT_EQ(fault(folder, "ground"), "lab/ground/certificate.pem is revoked");
  EXPECT_THROW(revoke_identity(folder, folder.certificate("ground")), std::runtime_error) << "again";
  renew_identity(folder, "ground", 30);
  EXPECT_EQ(fault(folder, "ground"), "");
  renew_identity(folder, "control", 30);
  EXPECT_EQ(fault(folder, "control"), "");
}

TEST_F(SecurityFolderTest, KeyAndCertificateBelongTogether) {
  const SecurityFolder folder = make("lab");
  fs::copy(folder.private_key("ground"), folder.private_key("control"), fs::copy_options::overwrite_existing);
  EXPECT_EQ(fault(folder, "control"),
            "lab/control/private.key is not the key of lab/control/certificate.pem");
}

TEST_F(SecurityFolderTest, RefusesWhatIsNoCertificate) {
  const SecurityFolder folder = make("lab");
  std::ofstream(folder.certificate("control")) << "nonsense";
  EXPECT_EQ(fault(folder, "control"), "lab/control/certificate.pem is not a certificate");
  std::ofstream(folder.authority()) << "nonsense";
  EXPECT_EQ(fault(folder, "ground"), "lab/ca.pem is not a certificate");
}

// Fast DDS 2.9 takes permissions that any certificate of the authority has signed, unless OpenSSL refuses it for S/MIME.
TEST_F(SecurityFolderTest, OnlyTheAuthoritySigns) {
  const SecurityFolder folder = make("lab");
  const Credential authority = authority_of(folder);
  EXPECT_EQ(signed_text(sign(authority, "<allow/>"), authority.certificate), "<allow/>");
  EXPECT_FALSE(signed_text(sign(identity_of(folder, "ground"), "<allow/>"), authority.certificate));
  EXPECT_FALSE(signed_text(sign(authority_of(make("other")), "<allow/>"), authority.certificate));
  EXPECT_FALSE(
      signed_text(replaced(sign(authority, "<deny/>"), "<deny/>", "<allow/>"), authority.certificate));
  EXPECT_FALSE(signed_text("<allow/>", authority.certificate));
}

TEST_F(SecurityFolderTest, RefusesDocumentsOfAnotherFolderAndRole) {
  const SecurityFolder folder = make("lab");
  const SecurityFolder other = make("other");
  const auto fault_with = [&](const fs::path& file, const fs::path& by) {
    const std::string own = read_text_file(file);
    fs::copy(by, file, fs::copy_options::overwrite_existing);
    std::string fault_now = fault(folder, "control");
    std::ofstream(file) << own;
    return fault_now;
  };
  EXPECT_EQ(fault_with(folder.permissions("control"), other.permissions("control")),
            "lab/control/permissions.p7s is not signed by lab/ca.pem");
  EXPECT_EQ(fault_with(folder.permissions("control"), folder.permissions("ground")),
            "lab/control/permissions.p7s is not for CN=control,O=Swiftlet, the subject of "
            "lab/control/certificate.pem");
  EXPECT_EQ(fault_with(folder.governance(), other.governance()),
            "lab/governance.p7s is not signed by lab/ca.pem");
  EXPECT_EQ(fault_with(folder.revoked(), other.revoked()),
            "lab/revoked.pem is not the list of revoked certificates of lab/ca.pem");
  EXPECT_EQ(fault(folder, "control"), "");
}

TEST_F(SecurityFolderTest, RevokesEveryCertificateOfTheRole) {
  const SecurityFolder folder = make("lab");
  const std::string first = identity_of(folder, "ground").certificate;
  renew_identity(folder, "ground", 30);
  const std::string second = identity_of(folder, "ground").certificate;
  revoke_role(folder, "ground");
  EXPECT_TRUE(is_revoked(folder, first));
  EXPECT_TRUE(is_revoked(folder, second));
  EXPECT_EQ(fault(folder, "control"), "");
  EXPECT_EQ(refusal([&] { revoke_role(folder, "ground"); }), "lab/ground/certificate.pem is revoked already");

  renew_identity(folder, "ground", 30);
  EXPECT_EQ(fault(folder, "ground"), "");
  fs::remove_all(folder.path / "ground");  // as where only the authority is
  revoke_role(folder, "ground");
  fs::remove_all(folder.path / "issued");  // as of a folder that has not kept them
  revoke_role(folder, "control");
  EXPECT_EQ(fault(folder, "control"), "lab/control/certificate.pem is revoked");
}

TEST_F(SecurityFolderTest, RevokesItsOwnCertificatesOnly) {
  const SecurityFolder folder = make("lab");
  const SecurityFolder other = make("other");
  EXPECT_EQ(refusal([&] { revoke_identity(folder, other.certificate("ground")); }),
            "other/ground/certificate.pem is not a certificate of lab/ca.pem");
  fs::copy(other.authority_key(), folder.authority_key(), fs::copy_options::overwrite_existing);
  EXPECT_EQ(refusal([&] { revoke_role(folder, "ground"); }), "lab/ca.key is not the key of lab/ca.pem");
}

TEST_F(SecurityFolderTest, KeepsTheIdentityThatCannotBeRenewed) {
  const SecurityFolder folder = make("lab");
  fs::create_directory(folder.private_key("ground").string() + ".part");
  EXPECT_EQ(refusal([&] { renew_identity(folder, "ground", 30); }),
            "lab/ground/private.key.part: cannot be written: Is a directory");
  EXPECT_EQ(fault(folder, "ground"), "");
  fs::create_directory(folder.certificate("control").string() + ".part");
  EXPECT_EQ(refusal([&] { renew_identity(folder, "control", 30); }),
            "lab/control/certificate.pem: cannot be written: Is a directory");
  EXPECT_EQ(fault(folder, "control"), "");
  EXPECT_FALSE(fs::exists(folder.private_key("control").string() + ".part"));
}

TEST_F(SecurityFolderTest, NoCertificateOutlivesItsAuthority) {
  const SecurityFolder folder = make("lab", 3650);
  const std::string end = last_day_of(authority_of(folder).certificate);
  EXPECT_EQ(renew_identity(folder, "ground", 4000), end + ", when its authority expires");
  EXPECT_EQ(last_day_of(identity_of(folder, "ground").certificate), end);
  EXPECT_EQ(fault(folder, "ground"), "");
  const std::string sooner = renew_identity(folder, "ground", 30);
  EXPECT_EQ(sooner, last_day_of(identity_of(folder, "ground").certificate));
  EXPECT_LT(sooner, end);
}

TEST_F(SecurityFolderTest, NamesTheAuthorityThatHasExpired) {
  const SecurityFolder folder = make("lab");
  const Credential expired = make_authority("authority", -2);
  std::ofstream(folder.authority()) << expired.certificate;
  std::ofstream(folder.authority_key()) << expired.private_key;
  const std::string sentence = "lab/ca.pem has expired on " + last_day_of(expired.certificate);
  EXPECT_EQ(fault(folder, "control"), sentence);
  EXPECT_EQ(refusal([&] { renew_identity(folder, "control", 30); }), sentence);
}

}  // namespace swiftlet::io::security_folder_test
