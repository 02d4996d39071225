// Lower bound of the latency from sense to actuate: one process sends the bytes of an IMU sample at the
// plant's rate, another answers each with those of an actuator command. Over bare Fast DDS with this
// project's QoS profiles, and over a Unix socket.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <nlohmann/json.hpp>

#include "swiftlet_msgs/msg/ActuatorCommandPubSubTypes.h"
#include "swiftlet_msgs/msg/ImuPubSubTypes.h"

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/participant_qos.hpp"
#include "swiftlet/services/dds/qos/profiles.hpp"
#include "swiftlet/services/runtime/latency_histogram.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/security_keys.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kProcesses = 2;  // in the domain
constexpr const char* kVehicle = "kl1";
namespace fastdds = eprosima::fastdds::dds;
using messages::msg::ActuatorCommand;
using messages::msg::Imu;

constexpr int kBackToBack = 0;                   // in place of a rate
constexpr double kBackToBackSamples = 10'000.0;  // for each second

struct Options {
  double seconds = 5.0;
  std::vector<int> rates_hz{500, 1000};
  std::vector<std::string> transports;  // empty: all
  bool json = false;
  runtime::ProcessOptions process;
  // Options of the echo process.
  int echo_domain = -1;
  std::string security;  // folder of the keys, also of the echo process; empty: none
  int echo_socket = -1;
};

constexpr const char* kUdp = "udp";
constexpr const char* kSocket = "unix-socket";
constexpr const char* kSecureUdp = "udp-security";

// Makes the first calling thread real-time, once.
class ThreadSetUp {
 public:
  explicit ThreadSetUp(const runtime::RealtimeSettings& settings) : settings_(settings) {}
  void operator()() {
    if (done_) return;
    done_ = true;
    if (settings_.enabled) runtime::make_this_thread_realtime(settings_);
  }

 private:
  runtime::RealtimeSettings settings_;
  bool done_ = false;
};

template <class T>
T* require_created(T* made, const char* what) {
  if (made == nullptr) throw std::runtime_error(std::string("cannot create ") + what);
  return made;
}

// A participant with one writer and one reader.
template <class Sent, class SentType, class Received, class ReceivedType>
class BarePair final : private fastdds::DataReaderListener {
 public:
  BarePair(const Options& options, const char* name, int domain, const messages::Topic<Sent>& sent,
           const messages::Topic<Received>& received, std::function<void(const Received&)> on_sample)
      : on_sample_(std::move(on_sample)) {
    dds::NodeSettings settings;
    settings.name = name;
    settings.domain = domain;
    settings.localhost_only = true;
    settings.security = options.security;
    participant_ = require_created(
        fastdds::DomainParticipantFactory::get_instance()->create_participant(
            static_cast<std::uint32_t>(domain), dds::participant_qos(settings, kProcesses, guard(settings))),
        "participant");
    auto* const publisher =
        require_created(participant_->create_publisher(fastdds::PUBLISHER_QOS_DEFAULT), "publisher");
    auto* const subscriber =
        require_created(participant_->create_subscriber(fastdds::SUBSCRIBER_QOS_DEFAULT), "subscriber");
    writer_ = require_created(
        publisher->create_datawriter(topic<SentType>(wire_name(sent.name)), dds::writer_qos(sent.qos)),
        "writer");
    reader_ = require_created(subscriber->create_datareader(topic<ReceivedType>(wire_name(received.name)),
                                                            dds::reader_qos(received.qos), this,
                                                            fastdds::StatusMask::data_available()),
                              "reader");
  }
  ~BarePair() override {
    reader_->set_listener(nullptr);
    participant_->delete_contained_entities();
    fastdds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  BarePair(const BarePair&) = delete;
  BarePair& operator=(const BarePair&) = delete;

  void send(Sent& sample) { writer_->write(&sample); }

  bool matched() const {
    fastdds::PublicationMatchedStatus readers;
    fastdds::SubscriptionMatchedStatus writers;
    writer_->get_publication_matched_status(readers);
    reader_->get_subscription_matched_status(writers);
    return readers.current_count > 0 && writers.current_count > 0;
  }

 private:
  static std::string wire_name(const char* topic) { return std::string("rt/") + kVehicle + "/" + topic; }
  static std::shared_ptr<rtps::DatagramGuard> guard(const dds::NodeSettings& settings) {
    rtps::DatagramLimits limits;
    limits.security = !settings.security.empty();
    return std::make_shared<rtps::DatagramGuard>(io::NetworkKeys(), limits);
  }
  template <class Type>
  fastdds::Topic* topic(const std::string& name) {
    const fastdds::TypeSupport type(new Type());
    participant_->register_type(type);
    return require_created(participant_->create_topic(name, type.get_type_name(), fastdds::TOPIC_QOS_DEFAULT),
                           "topic");
  }

  void on_data_available(fastdds::DataReader* reader) override {
    fastdds::SampleInfo info;
    while (dds::succeeded(reader->take_next_sample(&sample_, &info))) {
      if (info.valid_data) on_sample_(sample_);
    }
  }

  std::function<void(const Received&)> on_sample_;
  Received sample_;
  fastdds::DomainParticipant* participant_ = nullptr;
  fastdds::DataWriter* writer_ = nullptr;
  fastdds::DataReader* reader_ = nullptr;
};
using BarePlant = BarePair<Imu, swiftlet_msgs::msg::ImuPubSubType, ActuatorCommand,
                           swiftlet_msgs::msg::ActuatorCommandPubSubType>;
using BareControl = BarePair<ActuatorCommand, swiftlet_msgs::msg::ActuatorCommandPubSubType, Imu,
                             swiftlet_msgs::msg::ImuPubSubType>;

// The echo process: runs until its standard input is closed.
void echo_dds(const Options& options) {
  std::unique_ptr<BareControl> pair;
  std::atomic<BareControl*> ready{nullptr};
  ThreadSetUp set_up(options.process.realtime);
  ActuatorCommand command;
  pair = std::make_unique<BareControl>(options, "control", options.echo_domain,
                                       messages::topics::kActuatorCommand, messages::topics::kImu,
                                       [&](const Imu& imu) {
                                         set_up();
                                         command.imu_sequence_number(imu.sequence_number());
                                         if (BareControl* const self = ready.load()) self->send(command);
                                       });
  ready = pair.get();
  char byte = 0;
  while (::read(STDIN_FILENO, &byte, 1) > 0) {
  }
}

// A datagram of the size of the DDS message; only the numbers have a meaning.
struct Datagram {
  std::uint64_t sequence;
  char rest[120];
};

void echo_socket(const Options& options) {
  ThreadSetUp set_up(options.process.realtime);
  set_up();
  Datagram datagram{};
  while (::recv(options.echo_socket, &datagram, sizeof datagram, 0) > 0) {
    if (::send(options.echo_socket, &datagram, sizeof datagram, 0) < 0) return;
  }
}

// Runs the echo process during its lifetime.
class EchoProcess {
 public:
  EchoProcess(const Options& options, std::vector<std::string> words, int kept_open) {
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("cannot make a pipe");
    words.insert(words.begin(), "ping_pong_bench");
    words.insert(words.end(), {"--priority", std::to_string(options.process.realtime.priority)});
    if (!options.process.realtime.enabled) words.emplace_back("--no-realtime");
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    child_ = ::fork();
    if (child_ == 0) {
      ::dup2(ends[0], STDIN_FILENO);
      ::close(ends[0]);
      ::close(ends[1]);
      if (kept_open >= 0) ::dup2(kept_open, kEchoSocket);
      ::execv("/proc/self/exe", arguments.data());
      ::_exit(127);
    }
    ::close(ends[0]);
    input_ = ends[1];
  }
  ~EchoProcess() {
    ::close(input_);
    ::waitpid(child_, nullptr, 0);
  }
  EchoProcess(const EchoProcess&) = delete;
  EchoProcess& operator=(const EchoProcess&) = delete;

  static constexpr int kEchoSocket = 9;  // file descriptor in the echo process

 private:
  pid_t child_ = -1;
  int input_ = -1;
};

// Round-trip times of one measurement, by sequence number from 1.
class RoundTrips {
 public:
  explicit RoundTrips(std::uint64_t count) : written_(count + 1) {}

  // Sends from its own thread, 0.5 s of warm-up and then the measurement; returns when all are answered or
  // 100 ms have passed.
  void pace(const Options& options, int rate_hz, const std::function<void(std::uint64_t)>& send) {
    std::thread([&] {
      if (options.process.realtime.enabled) runtime::make_this_thread_realtime(options.process.realtime);
      runtime::PeriodicTimer timer(1'000'000'000 / rate_hz, 1'000'000);
      for (int warm_up = 0; warm_up < rate_hz / 2; ++warm_up) {
        timer.wait();
        send(written_.size());
      }
      timer.wait();
      for (std::uint64_t sequence = 1; sequence < written_.size(); ++sequence) {
        timer.wait();
        written_[sequence] = runtime::monotonic_ns();
        send(sequence);
      }
    }).join();
    tests::eventually([this] { return answers_ == count(); },
                      100ms);  // answers that are still missing are lost
  }

  // Sends each sample when the one before is answered, from the thread that receives the answer.
  void back_to_back(const std::function<void(std::uint64_t)>& send) {
    const auto is_heard = [&] {
      send(written_.size());
      return heard_.load();
    };
    if (!tests::eventually(is_heard)) throw std::runtime_error("the other process does not answer");
    next_ = send;
    written_[1] = runtime::monotonic_ns();
    send(1);
    if (!tests::eventually([this] { return answers_ == count(); }))
      throw std::runtime_error("a sample was not answered");
  }

  // Called by the receiving thread.
  void answered(std::uint64_t sequence) {
    const std::int64_t now_ns = runtime::monotonic_ns();
    heard_ = true;
    if (sequence >= written_.size()) return;
    times_.record(now_ns - written_[sequence].load());
    if (next_ && sequence < count()) {
      written_[sequence + 1] = now_ns;
      next_(sequence + 1);
    }
    ++answers_;
  }

  std::uint64_t count() const { return written_.size() - 1; }
  const runtime::LatencyHistogram& times() const { return times_; }

 private:
  std::vector<std::atomic<std::int64_t>> written_;
  runtime::LatencyHistogram times_;
  std::atomic<bool> heard_{false};
  std::atomic<std::uint64_t> answers_{0};
  std::function<void(std::uint64_t)> next_;  // empty: paced
};

void over_udp(const Options& options, int rate_hz, RoundTrips& trips) {
  const dds::DomainLock lock;
  ThreadSetUp set_up(options.process.realtime);
  BarePlant pair(options, "plant", lock.domain(), messages::topics::kImu, messages::topics::kActuatorCommand,
                 [&](const ActuatorCommand& command) {
                   set_up();
                   trips.answered(command.imu_sequence_number());
                 });
  const EchoProcess process(
      options, {"--echo-domain", std::to_string(lock.domain()), "--security", options.security}, -1);
  if (!tests::eventually([&] { return pair.matched(); }))
    throw std::runtime_error("the other process was not found");
  Imu imu;
  const auto send = [&](std::uint64_t sequence) {
    imu.sequence_number(sequence);
    pair.send(imu);
  };
  rate_hz == kBackToBack ? trips.back_to_back(send) : trips.pace(options, rate_hz, send);
}

void over_secure_udp(Options options, int rate_hz, RoundTrips& trips) {
  const tests::TemporaryFolder folder;
  options.security = tests::make_security_keys(folder.path() / "keys", kVehicle);
  over_udp(options, rate_hz, trips);
}

void over_socket(const Options& options, int rate_hz, RoundTrips& trips) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) != 0) throw std::runtime_error("cannot make a socket");
  {
    const EchoProcess process(options, {"--echo-socket", std::to_string(EchoProcess::kEchoSocket)}, ends[1]);
    ::close(ends[1]);
    std::thread receiver([&] {
      ThreadSetUp set_up(options.process.realtime);
      set_up();
      Datagram datagram{};
      while (::recv(ends[0], &datagram, sizeof datagram, 0) > 0) trips.answered(datagram.sequence);
    });
    Datagram datagram{};
    const auto send = [&](std::uint64_t sequence) {
      datagram.sequence = sequence;
      if (::send(ends[0], &datagram, sizeof datagram, 0) < 0) throw std::runtime_error("cannot send");
    };
    rate_hz == kBackToBack ? trips.back_to_back(send) : trips.pace(options, rate_hz, send);
    ::shutdown(ends[0], SHUT_RDWR);
    receiver.join();
  }
  ::close(ends[0]);
}

nlohmann::ordered_json measure(const Options& options, const std::string& name, int rate_hz) {
  RoundTrips trips(
      static_cast<std::uint64_t>(options.seconds * (rate_hz == kBackToBack ? kBackToBackSamples : rate_hz)));
  if (name == kSocket) over_socket(options, rate_hz, trips);
  if (name == kSecureUdp) over_secure_udp(options, rate_hz, trips);
  if (name == kUdp) over_udp(options, rate_hz, trips);
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-3; };
  const runtime::LatencyHistogram& times = trips.times();
  return {{"transport", name},
          {"rate_hz", rate_hz},
          {"sent", trips.count()},
          {"lost", trips.count() - times.count()},
          {"p50_us", us(times.quantile_ns(0.5))},
          {"p99_us", us(times.quantile_ns(0.99))},
          {"p999_us", us(times.quantile_ns(0.999))},
          {"max_us", us(times.max_ns())}};
}

void run(Options options) {
  if (options.echo_domain >= 0) return echo_dds(options);
  if (options.echo_socket >= 0) return echo_socket(options);
  if (options.transports.empty()) options.transports = {kUdp, kSecureUdp, kSocket};
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  if (!options.json) {
    std::printf("IMU out to command back, us\n%-14s %6s %8s %8s %8s %8s %6s\n", "transport", "Hz", "p50",
                "p99", "p99.9", "max", "lost");
  }
  for (const std::string& transport : options.transports) {
    for (const int rate_hz : options.rates_hz) {
      const nlohmann::ordered_json row = measure(options, transport, rate_hz);
      rows.push_back(row);
      if (options.json) continue;
      std::printf("%-14s %6d %8.1f %8.1f %8.1f %8.1f %6d\n", transport.c_str(), rate_hz,
                  row["p50_us"].get<double>(), row["p99_us"].get<double>(), row["p999_us"].get<double>(),
                  row["max_us"].get<double>(), row["lost"].get<int>());
      std::fflush(stdout);
    }
  }
  if (options.json) std::printf("%s\n", rows.dump().c_str());
}

void add_options(runtime::CommandLine app, Options& options) {
  app.add_option("--seconds", options.seconds, "duration of each measurement, s").range(0.1, 3600.0);
  app.add_option("--rate", options.rates_hz,
                 "samples per second, 0 (DDS only): each when the one before is answered; may be repeated")
      .range(0, 10'000);
  app.add_option("--transport", options.transports, "only these transports; may be repeated")
      .one_of({kUdp, kSecureUdp, kSocket});
  app.add_flag("--json", options.json, "print JSON");
  app.add_option("--echo-domain", options.echo_domain, "").hidden();
  app.add_option("--echo-socket", options.echo_socket, "").hidden();
  app.add_option("--security", options.security, "").hidden();
  runtime::add_process_options(app, options.process);
}

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  using namespace swiftlet;
  Options options;
  options.process.realtime.priority = 60;
  return runtime::run_process(
      {"ping_pong_bench",
       "Round trip of an IMU sample and its actuator command between two processes that do nothing else.",
       "--seconds 10 --transport udp --json"},
      argc, argv, [&](runtime::CommandLine app) { add_options(app, options); }, [&] { run(options); });
}
