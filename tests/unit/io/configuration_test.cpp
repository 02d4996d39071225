#include "swiftlet/io/configuration.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <unistd.h>

#include <gtest/gtest.h>

#include "swiftlet/io/program_directory.hpp"
#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::io::configuration_test {

namespace fs = std::filesystem;
using tests::refusal;

// A temporary folder with a file, which SWIFTLET_CONFIG_DIR names during the test.
class FindConfig : public testing::Test {
 protected:
  FindConfig() : folder_(fs::temp_directory_path() / ("swiftlet-find-config-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_ / "vehicles");
    std::ofstream(folder_ / "vehicles" / "own.yaml") << "a: 1\n";
    ::setenv("SWIFTLET_CONFIG_DIR", folder_.c_str(), 1);
  }
  void TearDown() override {
    ::unsetenv("SWIFTLET_CONFIG_DIR");
    fs::remove_all(folder_);
  }

  fs::path folder_;
};

TEST_F(FindConfig, UsesAnExistingPathAsGiven) {
  const std::string path = (folder_ / "vehicles" / "own.yaml").string();
  EXPECT_EQ(find_config(path), path);
}

TEST_F(FindConfig, SearchesTheFolderOfTheEnvironment) {
  EXPECT_EQ(find_config("vehicles/own.yaml"), (folder_ / "vehicles" / "own.yaml").string());
}

TEST_F(FindConfig, RefusesAFolder) {
  EXPECT_NE(refusal([] { find_config("vehicles"); }).find("is not found"), std::string::npos);
}

TEST_F(FindConfig, SearchesBesideTheExecutable) {
  ::unsetenv("SWIFTLET_CONFIG_DIR");
  const std::vector<std::string> directories = config_directories();
  ASSERT_EQ(directories.size(), 2U);
  const fs::path executable = fs::read_symlink("/proc/self/exe");
  EXPECT_EQ(directories[0], (executable.parent_path().parent_path() / "share/swiftlet/config").string());
  EXPECT_EQ(directories[1], (executable.parent_path().parent_path().parent_path() / "config").string());
}

TEST_F(FindConfig, SearchesBesideTheProgramsOfALibraryThatAnotherProgramLoads) {
  ::unsetenv("SWIFTLET_CONFIG_DIR");
  set_program_directory("/opt/swiftlet/bin");
  const std::vector<std::string> directories = config_directories();
  set_program_directory({});
  EXPECT_EQ(directories, (std::vector<std::string>{"/opt/swiftlet/share/swiftlet/config", "/opt/config"}));
  EXPECT_EQ(program_directory(), fs::read_symlink("/proc/self/exe").parent_path());
}

TEST_F(FindConfig, OfAPackageIsInEtc) {
  ::unsetenv("SWIFTLET_CONFIG_DIR");
  set_program_directory("/usr/bin");
  const std::vector<std::string> directories = config_directories();
  set_program_directory({});
  EXPECT_EQ(directories,
            (std::vector<std::string>{"/etc/swiftlet", "/usr/share/swiftlet/config", "/config"}));
}

TEST_F(FindConfig, ErrorListsTheSearchedPaths) {
  const std::string sentence = refusal([] { find_config("vehicles/none.yaml"); });
  EXPECT_EQ(sentence.rfind("vehicles/none.yaml: is not found, looked for vehicles/none.yaml, " +
                               (folder_ / "vehicles/none.yaml").string() + ", ",
                           0),
            0U)
      << sentence;
  EXPECT_NE(sentence.find("/share/swiftlet/config/vehicles/none.yaml"), std::string::npos);
}

TEST_F(FindConfig, TakesNamesOfAKind) {
  EXPECT_EQ(configuration_file(kinds::kVehicle, "own"), folder_ / "vehicles" / "own.yaml");
  EXPECT_EQ(refusal([] {
              configuration_file(kinds::kVehicle, "owl");
            }).rfind("No vehicle 'owl'. Did you mean 'own'? Available: ", 0),
            0U);
}

TEST_F(FindConfig, TakesTheNameOfAFileHere) {
  const fs::path here = fs::current_path();
  fs::current_path(folder_);
  std::ofstream("house.yaml") << "a: 1\n";
  const fs::path found = configuration_file(kinds::kMission, "house");
  fs::current_path(here);
  EXPECT_EQ(found, "house.yaml");
}

TEST_F(FindConfig, SearchesAnAbsolutePathOnce) {
  EXPECT_EQ(refusal([] { find_config("/nonexistent.yaml"); }),
            "/nonexistent.yaml: is not found, looked for /nonexistent.yaml");
}

}  // namespace swiftlet::io::configuration_test
