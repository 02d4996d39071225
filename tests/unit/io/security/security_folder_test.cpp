// Keys and certificates of DDS Security.
#include "swiftlet/io/security/security_folder.hpp"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "swiftlet/io/security/certificates.hpp"
#include "swiftlet/io/text_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::runtime {
namespace {

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
    const SecurityFolder folder{temporary_.path() / name};
    make_security_folder(folder, kTwoRoles,
                         {"<governance/>", [](const std::string& role) { return "<of>" + role + "</of>"; }},
                         days);
    return folder;
  }
  // Without the names of folders.
  std::string fault(const SecurityFolder& folder, const std::string& role) const {
    return replaced(fault_of_security_folder(folder, role), temporary_.path().string() + "/", "");
  }

  tests::TemporaryFolder temporary_;
};

TEST_F(SecurityFolderTest, EveryRoleCanJoin) {
  const SecurityFolder folder = make("lab");
  for (const std::string& role : kTwoRoles) EXPECT_EQ(fault(folder, role), "");
  const std::string permissions = read_text_file(folder.permissions("control"));
  EXPECT_EQ(permissions.find("MIME-Version: 1.0"), 0U);
  EXPECT_NE(permissions.find("<of>control</of>"), std::string::npos);
  EXPECT_NE(permissions.find("application/x-pkcs7-signature"), std::string::npos);
}

TEST_F(SecurityFolderTest, IsMadeAsAWhole) {
  const SecurityFolder folder = make("lab");
  EXPECT_THROW(make("lab"), std::runtime_error) << "it exists";
  EXPECT_THROW(make_security_folder(
                   {temporary_.path() / "half"}, kTwoRoles,
                   {"", [](const std::string&) -> std::string { throw std::runtime_error("no"); }}, 30),
               std::runtime_error);
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(temporary_.path()))
    names.push_back(entry.path().filename());
  EXPECT_EQ(names, std::vector<std::string>{"lab"});
}

TEST_F(SecurityFolderTest, NamesWhatIsMissing) {
  const SecurityFolder folder = make("lab");
  EXPECT_EQ(fault(folder, "mocap"), "lab/mocap/certificate.pem: cannot be read: No such file or directory");
  fs::remove(folder.permissions("ground"));
  EXPECT_EQ(fault(folder, "ground"), "lab/ground/permissions.p7s is missing");
  EXPECT_THROW(renew_identity(folder, "ground", 30), std::runtime_error);
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
  EXPECT_EQ(fault(folder, "control").rfind("cannot read a certificate", 0), 0U);
}

}  // namespace
}  // namespace swiftlet::runtime
