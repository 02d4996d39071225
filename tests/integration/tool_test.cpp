// Shell completion, manual pages, and behaviour at a terminal.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <regex>
#include <sstream>
#include <utility>

#include "tests/support/online_flight.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/terminal.hpp"

namespace swiftlet::tests {
namespace {

using control::Mode;

class Tool : public testing::Test {
 protected:
  ProgramResult run(std::vector<std::string> words) const {
    return run_program("swiftlet", std::move(words), folder_.path());
  }

  // Completions of the last word by bash.
  std::vector<std::string> completed(const std::vector<std::string>& words) const {
    const std::string script = folder_.write("completion.bash", run({"completion", "bash"}).output);
    std::string array;
    for (const std::string& word : words) array += " '" + word + "'";
    const std::string test =
        folder_.write("complete.bash", "source '" + script + "'\nCOMP_WORDS=(" + array +
                                           ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) +
                                           "\n_swiftlet\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
    const ProgramResult result = run_program("/bin/bash", {"--norc", "-u", test}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    std::vector<std::string> found;
    std::istringstream lines(result.output);
    for (std::string line; std::getline(lines, line);) {
      if (!line.empty()) found.push_back(line);
    }
    return found;
  }

  TemporaryFolder folder_;
};

using Words = std::vector<std::string>;

TEST_F(Tool, BashCompletesCommandsOptionsAndTheirValues) {
  EXPECT_EQ(completed({"swiftlet", "tak"}), Words({"takeoff"}));
  EXPECT_EQ(completed({"swiftlet", "sim", "fl"}), Words({"fly"}));
  EXPECT_EQ(completed({"swiftlet", "stream", "--ra"}), Words({"--rate"}));
  EXPECT_EQ(completed({"swiftlet", "fly", "--clock", ""}), Words({"realtime", "lockstep"}));
  EXPECT_EQ(completed({"swiftlet", "fly", "--clock", "=", "l"}), Words({"lockstep"}));
  EXPECT_EQ(completed({"swiftlet", "fly", "--clock", "="}), Words({"realtime", "lockstep"}));
  EXPECT_EQ(completed({"swiftlet", "completion", "z"}), Words({"zsh"}));
  EXPECT_EQ(completed({"swiftlet", "report", ""}), Words()) << "bash completes files itself";
  EXPECT_EQ(completed({"swiftlet", "fly", "--record", ""}), Words());
}

TEST_F(Tool, BashCompletesNamesOfConfigurationFilesAndVehicles) {
  // The script asks the program that is typed: this one prints what it was asked.
  const std::string asked = folder_.write("swiftlet", "#!/bin/sh\necho \"asked:$*\" | tr ' ' _\n");
  std::filesystem::permissions(asked, std::filesystem::perms::owner_all);
  EXPECT_EQ(completed({asked, "fly", ""}), Words({"asked:config_ls_--names_missions"}));
  EXPECT_EQ(completed({asked, "mission", "check", "as"}), Words({"asked:config_ls_--names_missions"}));
  EXPECT_EQ(completed({asked, "gains", "--vehicle", ""}), Words({"asked:config_ls_--names_vehicles"}));
  EXPECT_EQ(completed({asked, "set", "control", ""}), Words({"asked:config_ls_--names_control"}));
  EXPECT_EQ(completed({asked, "arm", "--vehicle-name", ""}), Words({"asked:list_--names_--time_0.5"}));
  EXPECT_EQ(run({"config", "ls", "--names", "missions"}).output,
            "calibration\nidentification\nsquare\ntour\nzigzag\n");
}

TEST_F(Tool, AllProgramsFailIfTheirOutputCannotBeWritten) {
  const std::vector<std::pair<std::string, std::string>> commands = {
      {"swiftlet", "config ls"},    {"swiftlet", "config show kaylion"}, {"swiftlet-identify", "--help"},
      {"swiftlet-plant", "--help"}, {"swiftlet-mocap", "--version"},     {"swiftlet-control", "--help"}};
  for (const auto& [program, arguments] : commands) {
    const ProgramResult result = run_program(
        "/bin/sh", {"-c", "'" + program_file(program) + "' " + arguments + " > /dev/full"}, folder_.path());
    EXPECT_EQ(result.exit_code, 1) << program;
    const std::string name = program == "swiftlet-identify" ? "swiftlet" : program;
    EXPECT_EQ(result.errors, name + ": cannot write to standard output: No space left on device\n");
  }
}

TEST_F(Tool, ConfigListsAndPrintsNamedFiles) {
  const std::string list = run({"config", "ls"}).output;
  for (const char* part : {"vehicles\n", "  kaylion          KayLion, the micro quadrotor", "missions\n",
                           "  square           Square of 2 m, height kept (Fig. 8)\n", "control\n"})
    EXPECT_NE(list.find(part), std::string::npos) << part << "\n" << list;
  const std::string path = run({"config", "show", "--path", "motor_lag"}).output;
  EXPECT_NE(path.find("config/control/motor_lag.yaml\n"), std::string::npos) << path;
  const std::string shown = run({"config", "show", "vehicles/kaylion"}).output;
  EXPECT_EQ(shown.rfind("# /", 0), 0U) << shown;
  EXPECT_NE(shown.find("\nmass: {value: "), std::string::npos) << shown;
  const ProgramResult unknown = run({"config", "show", "squre"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.errors.find("No configuration file 'squre'. Did you mean 'square'?"), std::string::npos)
      << unknown.errors;
  EXPECT_EQ(run({"config", "ls", "moons"}).exit_code, 2);
}

TEST_F(Tool, ProgramsPrintTheirVersion) {
  const std::regex form("swiftlet [0-9]+\\.[0-9]+\\.[0-9]+(, commit [0-9a-f]{10}(-dirty)?)?\n");
  for (const char* program : {"swiftlet", "swiftlet-plant", "swiftlet-mocap", "swiftlet-control",
                              "swiftlet-vehicle-template", "swiftlet-microcontroller"}) {
    const ProgramResult result = run_program(program, {"--version"}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << program;
    EXPECT_TRUE(std::regex_match(result.output, form)) << program << ": " << result.output;
  }
}

TEST_F(Tool, EveryCommandHasACompletionAndAManualPage) {
  const std::string pages = folder_.path() / "man";
  ASSERT_EQ(run({"man", "--into", pages}).exit_code, 0);
  const Words commands = completed({"swiftlet", ""});
  EXPECT_GT(commands.size(), 15U);
  const std::string help = run({"--help"}).output;
  for (const std::string& command : commands) {
    EXPECT_NE(help.find("\n  " + command + " "), std::string::npos) << command;
    EXPECT_TRUE(std::filesystem::exists(pages + "/swiftlet-" + command + ".1")) << command;
  }
  EXPECT_TRUE(std::filesystem::exists(pages + "/swiftlet.1"));
  EXPECT_TRUE(std::filesystem::exists(pages + "/swiftlet-sim-fly.1"));
}

TEST_F(Tool, ManualPagesPassGroff) {
  ASSERT_TRUE(std::filesystem::exists("/usr/bin/groff")) << "install the packages of packages.txt";
  const std::string pages = folder_.path() / "man";
  ASSERT_EQ(run({"man", "--into", pages}).exit_code, 0);
  int count = 0;
  for (const auto& page : std::filesystem::directory_iterator(pages)) {
    const ProgramResult result =
        run_program("/usr/bin/groff", {"-ww", "-man", "-Tutf8", "-z", page.path()}, folder_.path());
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.errors, "") << page.path();
    ++count;
  }
  EXPECT_GT(count, 20);
}

TEST_F(Tool, ManualPageMatchesTheHelp) {
  const ProgramResult page = run({"man", "stream"});
  EXPECT_EQ(page.exit_code, 0);
  for (const char* part : {".TH SWIFTLET-STREAM 1", "\\fB\\-\\-rate\\fR", "\\fIfile\\fR", ".SH EXIT STATUS"})
    EXPECT_NE(page.output.find(part), std::string::npos) << part << "\n" << page.output;
  EXPECT_EQ(run({"man", "fl"}).exit_code, 2);
  EXPECT_EQ(run({"completion", "fish"}).exit_code, 2);
}

class AtATerminal : public OnlineFlight {
 protected:
  Terminal open(std::vector<std::string> words) const {
    return {"swiftlet", on_network(std::move(words)), 80, 24};
  }
};

bool shows(Terminal& terminal, const std::string& text) {
  const bool shown = eventually([&] { return terminal.text().find(text) != std::string::npos; });
  EXPECT_TRUE(shown) << text << "\n" << terminal.text();
  return shown;
}

TEST_F(AtATerminal, WatchShowsTheFlightAndExecutesKeys) {
  take_off();
  Terminal terminal = open({"watch"});
  ASSERT_TRUE(shows(terminal, ": holding (take-off completed), airborne"));
  for (const char* part :
       {"position ", "reference ", "battery ", "latency ", "rates ", "h hold   l land   s stop"})
    ASSERT_TRUE(shows(terminal, part));

  terminal.resize(50, 8);
  ASSERT_TRUE(eventually([&] { return terminal.line(7).rfind("terminal too small", 0) == 0; }))
      << terminal.text();
  EXPECT_EQ(terminal.line(6).rfind("h hold", 0), 0U) << terminal.text();
  EXPECT_EQ(terminal.line(0).rfind("kl7 in domain", 0), 0U) << terminal.text();
  terminal.resize(120, 40);
  ASSERT_TRUE(eventually([&] { return terminal.line(39).rfind("h hold", 0) == 0; })) << terminal.text();

  terminal.type("l");
  ASSERT_TRUE(shows(terminal, "land: descend vertically? y confirms"));
  terminal.type("x");
  ASSERT_TRUE(shows(terminal, "land: not confirmed"));
  EXPECT_EQ(state().mode, Mode::kHolding);
  terminal.type("l");
  ASSERT_TRUE(shows(terminal, "land: descend vertically? y confirms"));
  terminal.type("y");
  ASSERT_TRUE(shows(terminal, "land: accepted"));
  ASSERT_TRUE(shows(terminal, ": disarmed (landed)"));
  terminal.type("q");
  EXPECT_EQ(terminal.wait(kStuck), 0);
  EXPECT_TRUE(terminal.is_restored());

  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Terminal interrupted = open({"watch"});
    ASSERT_TRUE(shows(interrupted, "disarmed"));
    EXPECT_FALSE(interrupted.is_restored());
    interrupted.signal(signal);
    EXPECT_EQ(interrupted.wait(kStuck), 0) << signal;
    EXPECT_TRUE(interrupted.is_restored()) << signal;
  }
}

class AtATerminalWithAPatientVehicle : public AtATerminal {
 protected:
  void SetUp() override { start("10", {"--patience", "600"}); }
};

// Waits for the wall clock, by which silence is measured. GIVEN a watch that asks a question, and a command that waits for
// its result WHEN control falls silent THEN the watch says so and keeps its question, and the command ends.
TEST_F(AtATerminalWithAPatientVehicle, ToolsNoticeASilentControlService) {
  take_off();
  Program going = begin({"goto", "2", "0", "-0.6", "--speed", "0.02"});
  ASSERT_TRUE(eventually([&] { return going.output() == "goto: accepted by kl7\n"; })) << going.errors();
  Terminal terminal = open({"watch"});
  const std::string question = "land: descend vertically? y confirms";
  ASSERT_TRUE(shows(terminal, "position "));
  terminal.type("l");
  ASSERT_TRUE(shows(terminal, question));
  control_->signal(SIGSTOP);
  ASSERT_TRUE(shows(terminal, "CONTROL SERVICE SILENT"));
  EXPECT_NE(terminal.text().find(question), std::string::npos) << terminal.text();
  terminal.type("x");
  ASSERT_TRUE(shows(terminal, "land: not confirmed"));
  EXPECT_EQ(going.wait(kStuck), 1);
  EXPECT_NE(going.errors().find("no control_status for 3 s"), std::string::npos) << going.errors();
  control_->signal(SIGCONT);
  ASSERT_TRUE(shows(terminal, "control process connected again"));
}

TEST_F(AtATerminal, GotoShowsItsProgressCtrlCHoldsAndStopAsks) {
  take_off();
  Terminal going = open({"goto", "2", "0", "-0.6", "--speed", "0.02"});
  ASSERT_TRUE(shows(going, " %  holding  ("));
  going.type("\x03");
  EXPECT_EQ(going.wait(kStuck), 1);
  EXPECT_TRUE(shows(going, "swiftlet: goto: interrupted; kl7 holds"));
  ASSERT_TRUE(eventually([&] {
    const json request = status().at("request");
    return request.at("kind") == "hold" && request.at("state") == "succeeded";
  }));
  EXPECT_LT(state().position_ned_m.x(), 1.9);
  {
    Terminal unsure = open({"stop"});
    ASSERT_TRUE(shows(unsure, "Type stop to do it:"));
    unsure.type("y\n");
    EXPECT_EQ(unsure.wait(kStuck), 2);
    EXPECT_TRUE(shows(unsure, "not confirmed, nothing was sent"));
  }
  EXPECT_EQ(status().at("mode"), "holding");
  Terminal sure = open({"stop"});
  ASSERT_TRUE(shows(sure, "Type stop to do it:"));
  sure.type("stop\n");
  EXPECT_EQ(sure.wait(kStuck), 0);
  EXPECT_EQ(status().at("mode"), "stopped");
}

}  // namespace
}  // namespace swiftlet::tests
