#include "swiftlet/ground/cli/analysis/log/control_replay.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/ground/flight/process_group.hpp"
#include "swiftlet/ground/replay/topic_publishers.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/command_line/installation.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/temporary_folder.hpp"
#include "swiftlet/record/mcap/attached_file.hpp"
#include "swiftlet/record/mcap/message_decoder.hpp"
#include "swiftlet/record/mcap/series.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/payload.hpp"
#include "swiftlet/services/messages/schemas.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;
namespace topics = messages::topics;
namespace fs = std::filesystem;
using Steady = std::chrono::steady_clock;
using RequestKey = std::pair<std::uint64_t, std::uint64_t>;  // client and id

constexpr auto kRepeatPeriod = 20ms;  // an unanswered IMU sample is sent again
constexpr auto kStartTimeout = 15s;
constexpr auto kReplayTimeout = 5s;
constexpr auto kReliableTimeout = 2s;
constexpr double kMissingShare = 0.01;  // of the recorded commands
constexpr auto kSetpointPause = 200us;  // a setpoint has no answer

struct Recorded {
  std::int64_t log_time_ns = 0;
  std::uint64_t sequence = 0;  // of the sample
  std::string topic;           // "mocap_pose"
  mcap::Bytes payload;
};

mcap::ByteView view_of(const mcap::Bytes& bytes) { return {bytes.data(), bytes.size()}; }

template <class T>
std::optional<T> message_in(mcap::ByteView payload) {
  T message;
  if (!dds::from_payload(payload.data, payload.size, message)) return std::nullopt;
  return message;
}

struct Level {
  const char* name;   // of the option --level
  const char* topic;  // of its commands
};
constexpr std::array kLevels = {
    Level{"actuators", topics::kActuatorCommand.name}, Level{"rates", topics::kRatesSetpoint.name},
    Level{"attitude", topics::kAttitudeSetpoint.name}, Level{"trajectory", topics::kTrajectorySetpoint.name}};

// What the vehicle, motion capture and the ground sent.
class Inputs {
 public:
  Inputs(const mcap::Reader& file, const std::string& vehicle) {
    const std::string prefix = "/" + vehicle + "/";
    mcap::Selection selection;
    for (const char* const topic : kSamples) selection.topics.insert(prefix + topic);
    for (const char* const topic : kBetweenSamples) selection.topics.insert(prefix + topic);
    for (const Level& level : kLevels) selection.topics.insert(prefix + level.topic);
    selection.topics.insert(prefix + topics::kImu.name);
    selection.topics.insert(prefix + topics::kCommandAck.name);
    mcap::Messages messages(file, selection);
    while (messages.next()) take(messages.channel().topic.substr(prefix.size()), messages.message());
    if (imu.empty()) throw io::ConfigError(file.name(), 0, prefix + topics::kImu.name, "has no messages");
    if (command_topic.empty())
      throw io::ConfigError(file.name(), 0, prefix + topics::kActuatorCommand.name,
                            "has no messages, nor have the setpoints of other levels");
    const bool described = std::any_of(between.begin(), between.end(), [](const Recorded& message) {
      return message.topic == topics::kVehicleInfo.name;
    });
    if (!described)
      throw io::ConfigError(file.name(), 0, prefix + topics::kVehicleInfo.name,
                            "has no messages; control needs one to know the vehicle's levels");
  }

  static constexpr std::array kSamples = {topics::kMocapPose.name, topics::kBattery.name,
                                          topics::kRotorSpeeds.name};
  static constexpr std::array kBetweenSamples = {topics::kVehicleInfo.name,     topics::kCommand.name,
                                                 topics::kMission.name,         topics::kTrajectory.name,
                                                 topics::kControlSettings.name, topics::kSetpoint.name,
                                                 topics::kGroundLink.name};

  std::vector<Recorded> imu;                               // of rising sequence numbers
  std::map<std::string, std::vector<Recorded>> samples;    // likewise, by topic
  std::vector<Recorded> between;                           // the rest, in order of time
  std::map<RequestKey, bool> answers;                      // whether a request was accepted
  std::map<std::uint64_t, std::uint64_t> pose_of_command;  // by IMU sample: the newest pose that control had
  std::string command_topic;
  bool lockstep = false;  // the IMU samples name those that must have come before

 private:
  void take(const std::string& topic, const mcap::Message& message) {
    Recorded recorded{
        message.log_time_ns, 0, topic, {message.payload.data, message.payload.data + message.payload.size}};
    if (topic == topics::kImu.name) return take_imu(std::move(recorded));
    if (topic == topics::kMocapPose.name) return take_sample<messages::msg::MocapPose>(std::move(recorded));
    if (topic == topics::kBattery.name) return take_sample<messages::msg::Battery>(std::move(recorded));
    if (topic == topics::kRotorSpeeds.name)
      return take_sample<messages::msg::RotorSpeeds>(std::move(recorded));
    if (topic == topics::kCommandAck.name) {
      if (const auto ack = message_in<messages::msg::CommandAck>(message.payload))
        answers[{ack->client(), ack->id()}] = ack->accepted();
      return;
    }
    if (topic == topics::kActuatorCommand.name) take_command<messages::msg::ActuatorCommand>(recorded);
    if (topic == topics::kRatesSetpoint.name) take_command<messages::msg::RatesSetpoint>(recorded);
    if (topic == topics::kAttitudeSetpoint.name) take_command<messages::msg::AttitudeSetpoint>(recorded);
    if (topic == topics::kTrajectorySetpoint.name) take_command<messages::msg::TrajectorySetpoint>(recorded);
    if (std::find(kBetweenSamples.begin(), kBetweenSamples.end(), topic) != kBetweenSamples.end())
      between.push_back(std::move(recorded));
  }

  void take_imu(Recorded recorded) {
    const auto sample = message_in<messages::msg::Imu>(view_of(recorded.payload));
    if (!sample || (!imu.empty() && sample->sequence_number() <= imu.back().sequence)) return;
    lockstep = lockstep || sample->lockstep().mocap_pose() > 0;
    recorded.sequence = sample->sequence_number();
    imu.push_back(std::move(recorded));
  }

  template <class T>
  void take_sample(Recorded recorded) {
    const auto sample = message_in<T>(view_of(recorded.payload));
    auto& all = samples[recorded.topic];
    if (!sample || sample->sequence_number() <= (all.empty() ? 0 : all.back().sequence)) return;
    recorded.sequence = sample->sequence_number();
    all.push_back(std::move(recorded));
  }

  template <class T>
  void take_command(const Recorded& recorded) {
    const auto command = message_in<T>(view_of(recorded.payload));
    if (!command) return;
    pose_of_command[command->imu_sequence_number()] = command->mocap_sequence_number();
    if (command_topic.empty()) command_topic = recorded.topic;
  }
};

// The commands of the control process, as it sends them.
class Answers {
 public:
  Answers(dds::Node& node, const std::string& topic) {
    if (topic == topics::kActuatorCommand.name) subscribe(node, topics::kActuatorCommand);
    if (topic == topics::kRatesSetpoint.name) subscribe(node, topics::kRatesSetpoint);
    if (topic == topics::kAttitudeSetpoint.name) subscribe(node, topics::kAttitudeSetpoint);
    if (topic == topics::kTrajectorySetpoint.name) subscribe(node, topics::kTrajectorySetpoint);
    acks_ = node.subscribe<messages::msg::CommandAck>(topics::kCommandAck,
                                                      [this](const messages::msg::CommandAck& ack) {
                                                        const std::lock_guard lock(mutex_);
                                                        accepted_[{ack.client(), ack.id()}] = ack.accepted();
                                                        changed_.notify_all();
                                                      });
  }

  // Both return false after the timeout.
  bool wait_for_command(std::uint64_t imu_sequence, std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, timeout, [&] { return answered_ >= imu_sequence; });
  }
  bool wait_for_answer(const RequestKey& key, std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, timeout, [&] { return accepted_.count(key) > 0; });
  }

  std::map<RequestKey, bool> accepted() const {
    const std::lock_guard lock(mutex_);
    return accepted_;
  }
  const mcap::Series& commands() const { return *commands_; }  // once the process has ended

 private:
  template <class T>
  void subscribe(dds::Node& node, const messages::Topic<T>& topic) {
    const messages::MessageSchema& schema = messages::schema_of<T>();
    decoder_.emplace(mcap::Schema{1, schema.name, "ros2msg", schema.definition});
    commands_.emplace("the replay", topic.name, decoder_->columns());
    subscription_ = node.subscribe_raw<T>(topic, [this](const dds::RawSample& sample) {
      const auto command = message_in<T>({sample.payload, sample.size});
      if (!command) return;
      const std::lock_guard lock(mutex_);
      if (command->imu_sequence_number() <= answered_) return;  // sent again
      answered_ = command->imu_sequence_number();
      mcap::Message message;
      message.log_time_ns = command->stamp_ns();
      if (decoder_->decode({sample.payload, sample.size}, values_)) commands_->append(message, values_);
      changed_.notify_all();
    });
  }

  mutable std::mutex mutex_;  // guards all below but the subscriptions
  std::condition_variable changed_;
  std::uint64_t answered_ = 0;
  std::map<RequestKey, bool> accepted_;
  std::optional<mcap::Series> commands_;
  std::optional<mcap::MessageDecoder> decoder_;
  std::vector<mcap::Value> values_;
  dds::Subscription subscription_;
  dds::Subscription acks_;
};

std::optional<RequestKey> key_of(const Recorded& request) {
  const auto key = [](const auto& message) -> std::optional<RequestKey> {
    if (!message) return std::nullopt;
    return RequestKey{message->client(), message->id()};
  };
  const mcap::ByteView payload = view_of(request.payload);
  if (request.topic == topics::kCommand.name) return key(message_in<messages::msg::Command>(payload));
  if (request.topic == topics::kMission.name) return key(message_in<messages::msg::Mission>(payload));
  if (request.topic == topics::kTrajectory.name) return key(message_in<messages::msg::Trajectory>(payload));
  if (request.topic == topics::kControlSettings.name)
    return key(message_in<messages::msg::ControlSettings>(payload));
  return std::nullopt;
}

// Sends the inputs in order, each IMU sample when the one before is answered.
class Feeder {
 public:
  Feeder(const Inputs& inputs, dds::Node& node, Answers& answers, ProcessGroup& control)
      : inputs_(inputs),
        publishers_(node, names()),
        imu_(node.publish(topics::kImu)),
        answers_(answers),
        control_(control) {}

  void feed(const std::function<bool(double)>& proceed) {
    for (std::size_t i = 0; i < inputs_.imu.size(); ++i) {
      const Recorded& imu = inputs_.imu[i];
      if (!proceed(static_cast<double>(i) / static_cast<double>(inputs_.imu.size())))
        throw std::runtime_error("the replay was interrupted");
      send_between(imu.log_time_ns, i == 0);
      auto sample = *message_in<messages::msg::Imu>(view_of(imu.payload));
      send_samples(imu, sample);
      sample.lockstep().mocap_pose(sent_[topics::kMocapPose.name]);
      sample.lockstep().battery(sent_[topics::kBattery.name]);
      sample.lockstep().rotor_speeds(sent_[topics::kRotorSpeeds.name]);
      sample.obeyed({});  // they obeyed another controller: unreported
      last_ = sample;
      send_until_answered(imu.sequence, i == 0 ? kStartTimeout : kReplayTimeout);
    }
    send_between(std::numeric_limits<std::int64_t>::max(), false);
  }
  std::uint64_t requests() const { return requests_; }

 private:
  static std::set<std::string> names() {
    std::set<std::string> names(Inputs::kSamples.begin(), Inputs::kSamples.end());
    names.insert(Inputs::kBetweenSamples.begin(), Inputs::kBetweenSamples.end());
    return names;
  }

  // The sequence number up to which control had the samples of a topic with this IMU sample.
  std::uint64_t due(const std::string& topic, const Recorded& imu, const messages::msg::Imu& sample) const {
    if (inputs_.lockstep) {
      if (topic == topics::kMocapPose.name) return sample.lockstep().mocap_pose();
      return topic == topics::kBattery.name ? sample.lockstep().battery() : sample.lockstep().rotor_speeds();
    }
    if (topic == topics::kMocapPose.name) {
      const auto command = inputs_.pose_of_command.find(imu.sequence);
      if (command != inputs_.pose_of_command.end()) return command->second;
    }
    std::uint64_t newest = 0;
    const auto all = inputs_.samples.find(topic);
    const auto next = next_.find(topic);
    for (std::size_t i = next == next_.end() ? 0 : next->second;
         all != inputs_.samples.end() && i < all->second.size() &&
         all->second[i].log_time_ns <= imu.log_time_ns;
         ++i)
      newest = all->second[i].sequence;
    return newest;
  }

  void send_samples(const Recorded& imu, const messages::msg::Imu& sample) {
    for (const auto& [topic, all] : inputs_.samples) {
      const std::uint64_t last = due(topic, imu, sample);
      std::size_t& next = next_[topic];
      while (next < all.size() && all[next].sequence <= last) {
        publishers_.publish(topic, view_of(all[next].payload));
        sent_[topic] = all[next].sequence;
        newest_[topic] = &all[next];
        ++next;
      }
    }
  }

  // What was recorded before this time, or with the first sample a description of the vehicle from later.
  void send_between(std::int64_t before_ns, bool first) {
    if (first) {
      const auto described =
          std::find_if(inputs_.between.begin(), inputs_.between.end(),
                       [](const Recorded& message) { return message.topic == topics::kVehicleInfo.name; });
      publishers_.publish(described->topic, view_of(described->payload));
    }
    for (; next_between_ < inputs_.between.size(); ++next_between_) {
      const Recorded& message = inputs_.between[next_between_];
      if (message.log_time_ns >= before_ns) return;
      publishers_.publish(message.topic, view_of(message.payload));
      if (message.topic == topics::kSetpoint.name) {
        std::this_thread::sleep_for(kSetpointPause);
        continue;
      }
      publishers_.wait_until_received(message.topic, kReliableTimeout);
      const auto key = key_of(message);
      if (!key) continue;
      ++requests_;
      if (inputs_.lockstep && last_) wait_for_answer(*key);
    }
  }

  // Time stood still when the request came: it is answered at the last sample, which is repeated.
  void wait_for_answer(const RequestKey& key) {
    const auto deadline = Steady::now() + kReliableTimeout;
    while (Steady::now() < deadline && !answers_.wait_for_answer(key, kRepeatPeriod)) imu_.publish(*last_);
  }

  void send_until_answered(std::uint64_t sequence, std::chrono::seconds timeout) {
    const auto deadline = Steady::now() + timeout;
    imu_.publish(*last_);
    while (!answers_.wait_for_command(sequence, kRepeatPeriod)) {
      if (const auto exited = control_.exited_process()) throw std::runtime_error(*exited);
      if (Steady::now() > deadline)
        throw std::runtime_error("control does not answer IMU sample " + std::to_string(sequence));
      for (const auto& [topic, sample] : newest_) publishers_.publish(topic, view_of(sample->payload));
      imu_.publish(*last_);
    }
  }

  const Inputs& inputs_;
  TopicPublishers publishers_;
  dds::Publisher<messages::msg::Imu> imu_;
  Answers& answers_;
  ProcessGroup& control_;
  std::map<std::string, std::size_t> next_;  // of the samples, by topic
  std::map<std::string, std::uint64_t> sent_;
  std::map<std::string, const Recorded*> newest_;
  std::size_t next_between_ = 0;
  std::optional<messages::msg::Imu> last_;
  std::uint64_t requests_ = 0;
};

// The given file, else the one that is attached to the recording, else the named one of the configuration.
std::string settings_file(const mcap::Reader& file, const std::string& of_vehicle, const fs::path& given,
                          const std::string& attachment, const std::string& fallback, const fs::path& folder,
                          std::string& said) {
  said = given.empty() ? fallback : given.string();
  if (!given.empty()) return given;
  const std::optional<std::string> recorded = mcap::attached_file(file, of_vehicle, attachment);
  if (!recorded) return fallback;
  said = "recorded";
  io::write_atomically(folder / attachment, *recorded);
  return folder / attachment;
}

}  // namespace

std::string difference_of(const ControlReplay& replay, double tolerance) {
  const analysis::TopicDifference& commands = replay.commands;
  if (commands.compared == 0 || commands.signals.empty())
    return "none of the recorded commands has a counterpart";
  // A command is repeated with its IMU sample. At the ends of a recording some have no counterpart.
  const std::uint64_t expected = std::min<std::uint64_t>(commands.messages_a, replay.imu_samples);
  if (static_cast<double>(commands.compared) < (1.0 - kMissingShare) * static_cast<double>(expected))
    return fmt::format("{} of {} recorded commands have no counterpart", expected - commands.compared,
                       expected);
  if (replay.other_answers > 0)
    return fmt::format("{} requests are answered otherwise", replay.other_answers);
  const auto worst = std::max_element(
      commands.signals.begin(), commands.signals.end(),
      [](const analysis::SignalDifference& a, const analysis::SignalDifference& b) { return a.max < b.max; });
  if (worst->max <= tolerance) return "";
  return fmt::format("{} differs by {:.3g} at {:.3f} s", worst->name, worst->max, worst->max_at_s);
}

ControlReplay replay_into_control(const mcap::Reader& file, const ControlReplaySettings& settings,
                                  const std::function<bool(double)>& proceed) {
  const Inputs inputs(file, settings.vehicle);
  const auto folder = io::TemporaryFolder::of_the_system("swiftlet-replay");
  ControlReplay replay;
  const std::string vehicle = settings_file(file, settings.vehicle, settings.vehicle_file, "vehicle.yaml",
                                            "kaylion", folder.path(), replay.vehicle_file);
  const std::string control = settings_file(file, settings.vehicle, settings.control_file, "control.yaml",
                                            "motor_lag", folder.path(), replay.control_file);
  const auto level = std::find_if(kLevels.begin(), kLevels.end(),
                                  [&](const Level& one) { return one.topic == inputs.command_topic; });
  const dds::DomainLock domain;
  dds::NodeSettings network;
  network.name = "plant";
  network.vehicle = settings.vehicle;
  network.domain = domain.domain();
  dds::Node node(network);
  mcap::Selection recorded;
  const std::string topic = "/" + settings.vehicle + "/" + inputs.command_topic;
  recorded.topics = {topic};
  const mcap::Series before = mcap::read_series(file, recorded).at(topic);
  Answers answers(node, inputs.command_topic);
  ProcessGroup process(
      {{"swiftlet-control",
        io::program_beside("swiftlet-control"),
        {"--vehicle", vehicle, "--control", control, "--level", level->name, "--clock", "lockstep",
         "--vehicle-name", settings.vehicle, "--domain", std::to_string(network.domain), "--localhost-only"},
        folder.path() / "swiftlet-control.log"}});
  Feeder feeder(inputs, node, answers, process);
  feeder.feed(proceed);
  const std::vector<std::string> errors = process.stop();
  if (!errors.empty()) throw std::runtime_error(errors.front());

  replay.imu_samples = inputs.imu.size();
  replay.requests = feeder.requests();
  const std::map<RequestKey, bool> accepted = answers.accepted();
  for (const auto& [key, was_accepted] : inputs.answers) {
    const auto now = accepted.find(key);
    if (now == accepted.end() || now->second != was_accepted) ++replay.other_answers;
  }
  replay.commands = analysis::difference(before, answers.commands(), 0, 0);
  return replay;
}

}  // namespace swiftlet::ground
