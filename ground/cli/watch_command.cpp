#include <cstdio>
#include <memory>
#include <optional>
#include <unistd.h>
#include <utility>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/client/connection_watch.hpp"
#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/terminal/terminal_screen.hpp"
#include "swiftlet/ground/terminal/watch_screen.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

constexpr int kFrame_ms = 100;
constexpr auto kRateTime = 1s;
constexpr auto kAnswerTimeout = 2s;
constexpr double kLandingSpeed_m_s = 0.4;

struct WatchOptions {
  dds::NodeSettings network;
  bool plain = false;
  std::optional<double> duration_s;
};

// Topic rates over the last second.
class WatchedRates {
 public:
  void update(const View& view, WatchFacts& facts) {
    const auto now = Clock::now();
    if (!begun_) {
      begun_ = now;
      before_ = view;
    }
    const double time_s = std::chrono::duration<double>(now - *begun_).count();
    if (now - *begun_ < kRateTime) return;
    const auto rate = [time_s](std::uint64_t before, std::uint64_t after) {
      return after >= before ? static_cast<double>(after - before) / time_s : 0.0;
    };
    facts.estimate_hz = rate(before_.estimate.count, view.estimate.count);
    facts.battery_hz = rate(before_.battery.count, view.battery.count);
    facts.pose_hz = rate(poses(before_), poses(view));
    begun_ = now;
    before_ = view;
  }

 private:
  static std::uint64_t poses(const View& view) {
    return view.estimate.message.poses_accepted() + view.estimate.message.poses_refused();
  }
  std::optional<Clock::time_point> begun_;
  View before_;
};

// Handles keys: a letter selects a request, y confirms it.
class Keys {
 public:
  explicit Keys(std::shared_ptr<Client> client) : vehicle_(std::move(client)) {}

  bool is_asking() const { return asked_ != nullptr; }

  // Returns false if the key quits.
  bool press(int key, std::string& message) {
    if (asked_ != nullptr) {
      message = key == 'y' || key == 'Y' ? answer_of(*asked_) : std::string(asked_->name) + ": not confirmed";
      asked_ = nullptr;
      return true;
    }
    if (key == 'q' || key == 'Q' || key == TerminalScreen::kEscape) return false;
    message.clear();
    for (const Action& action : kActions) {
      if (key != action.key) continue;
      asked_ = &action;
      message = action.question;
    }
    return true;
  }

 private:
  struct Action {
    char key;
    const char* name;
    const char* question;
    ActionHandle (*send)(Vehicle&);
  };
  static constexpr Action kActions[] = {
      {'h', "hold", "hold: come to rest and hold? y confirms, any other key cancels",
       [](Vehicle& vehicle) { return vehicle.hold(kAnswerTimeout); }},
      {'l', "land", "land: descend vertically? y confirms, any other key cancels",
       [](Vehicle& vehicle) { return vehicle.land(kLandingSpeed_m_s, kAnswerTimeout); }},
      {'s', "stop", "STOP: ROTORS OFF, FALL IF IN THE AIR? y confirms, any other key cancels",
       [](Vehicle& vehicle) { return vehicle.stop(kAnswerTimeout); }}};

  std::string answer_of(const Action& action) {
    const Result answer = action.send(vehicle_).answer();
    if (!answer.accepted()) return std::string(action.name) + ": " + answer.reason;
    return std::string(action.name) + ": accepted" + (answer.reason.empty() ? "" : "; " + answer.reason);
  }

  Vehicle vehicle_;
  const Action* asked_ = nullptr;
};

class Watch {
 public:
  explicit Watch(const WatchOptions& options)
      : client_(std::make_shared<Client>(options.network)), keys_(client_) {
    client_->hear_controllers();
    facts_.vehicle = options.network.vehicle;
    facts_.domain = options.network.domain;
    if (options.duration_s) {
      end_ = Clock::now() + std::chrono::milliseconds(static_cast<std::int64_t>(*options.duration_s * 1e3));
    }
  }

  int on_screen() {
    TerminalScreen screen;
    while (goes_on()) {
      screen.show(watch_screen(update(), facts_, Clock::now(), screen.width(), screen.height()));
      const std::optional<int> key = screen.key(kFrame_ms);
      if (key && *key != TerminalScreen::kResized && !keys_.press(*key, facts_.message)) break;
    }
    return io::kDone;
  }

  int in_lines() {
    while (goes_on()) {
      client_->wait(kRateTime, [this](const View&) { return !goes_on(); });
      const View view = update();
      if (!facts_.message.empty()) std::printf("%s\n", std::exchange(facts_.message, {}).c_str());
      std::printf("%s\n", watch_line(view, facts_, Clock::now()).c_str());
      std::fflush(stdout);
    }
    return client_->view().control.seen() ? io::kDone : io::kFailed;
  }

 private:
  bool goes_on() const { return interrupts_.count() == 0 && !(end_ && Clock::now() >= *end_); }

  View update() {
    View view = client_->view();
    rates_.update(view, facts_);
    facts_.system_now = std::chrono::system_clock::now();
    if (const auto event = connection_.update(view, Clock::now())) report(*event);
    if (!view.control.seen()) facts_.where = client_->no_control();
    return view;
  }

  // A question that waits for its answer stays on the screen.
  void report(const ConnectionEvent& event) {
    const bool is_news = event.kind != ConnectionEvent::Kind::kConnected || was_lost_;
    was_lost_ = event.kind == ConnectionEvent::Kind::kLost;
    if (is_news && !keys_.is_asking()) facts_.message = event.text;
  }

  const Interrupts interrupts_;
  std::shared_ptr<Client> client_;
  Keys keys_;
  WatchFacts facts_;
  WatchedRates rates_;
  ConnectionWatch connection_;
  bool was_lost_ = false;
  std::optional<Clock::time_point> end_;
};

int watch(const WatchOptions& options) {
  Watch watch(options);
  const bool terminal = isatty(STDOUT_FILENO) != 0 && isatty(STDIN_FILENO) != 0;
  return terminal && !options.plain ? watch.on_screen() : watch.in_lines();
}

}  // namespace

io::Command add_watch_command(runtime::CommandLine root) {
  const auto options = std::make_shared<WatchOptions>();
  const runtime::CommandLine app =
      root.add_subcommand("watch", "Show a vehicle full screen, with keys for hold, land and stop");
  add_network_options(app, options->network);
  app.add_flag("--plain", options->plain, "print a line a second, also on a terminal");
  app.add_option("--duration", options->duration_s, "end after so many s; default: end with q or Ctrl-C")
      .range(0.1, 86400.0);
  app.footer(
      "Who is silent comes first. h, l and s request hold, land and stop, each after a confirmation with y.\n"
      "Without a terminal, the command prints a line a second.\n\nexample: swiftlet watch --vehicle-name "
      "kl2");
  return {app, [options] { return watch(*options); }};
}

}  // namespace swiftlet::ground
