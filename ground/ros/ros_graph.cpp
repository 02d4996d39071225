#include "swiftlet/ground/ros/ros_graph.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/ground/ros/raw_type.hpp"
#include "swiftlet/record/file/cdr_writer.hpp"
#include "swiftlet/services/dds/checked_type_support.hpp"
#include "swiftlet/services/dds/participant_session.hpp"
#include "swiftlet/services/dds/periodic_task.hpp"
#include "swiftlet/services/dds/qos/profiles.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::ros {
namespace {

namespace fastdds = eprosima::fastdds::dds;
using dds::fastrtps::GUID_t;
using dds::fastrtps::GuidPrefix_t;

constexpr std::chrono::milliseconds kPeriod{100};
constexpr const char* kTopic = "ros_discovery_info";
constexpr const char* kRosPrefix = "rt/";

struct ParticipantEntities {
  static constexpr const char* kName = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";
  static constexpr const char* kTypeHash =
      "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e";
};
using EntitiesType = dds::CheckedTypeSupport<RawType<ParticipantEntities>>;

// A process of Swiftlet.
struct Process {
  std::string name;
  std::map<GUID_t, std::string> writers, readers;  // topics as ROS 2 has them on the wire: rt/kl1/imu
  bool changed = true;
  fastdds::DataWriter* announcer = nullptr;
};

// The numbers of the endpoints of a node.
struct Endpoints {
  std::vector<GUID_t> readers, writers;
};

// "/kl1" for rt/kl1/imu, "/" for rt/tf.
std::string namespace_of(const std::string& topic) {
  const std::size_t begin = std::char_traits<char>::length(kRosPrefix);
  const std::size_t end = topic.rfind('/');
  return end < begin ? "/" : "/" + topic.substr(begin, end - begin);
}

// Names of nodes have letters, digits and underscores.
std::string node_name(std::string process) {
  std::replace(process.begin(), process.end(), '-', '_');
  return process;
}

std::map<std::string, Endpoints> nodes_of(const Process& process) {
  std::map<std::string, Endpoints> nodes;  // by namespace
  for (const auto& [guid, topic] : process.readers) nodes[namespace_of(topic)].readers.push_back(guid);
  for (const auto& [guid, topic] : process.writers) nodes[namespace_of(topic)].writers.push_back(guid);
  return nodes;
}

void put_gid(record::CdrWriter& out, const GUID_t& guid, std::size_t gid_bytes) {
  for (const std::uint8_t octet : guid.guidPrefix.value) out.put(octet);
  for (const std::uint8_t octet : guid.entityId.value) out.put(octet);
  for (std::size_t i = kGidBytes; i < gid_bytes; ++i) out.put(std::uint8_t{0});
}

// rmw_dds_common/msg/ParticipantEntitiesInfo.
Bytes entities_message(const GuidPrefix_t& participant, const Process& process, std::size_t gid_bytes) {
  record::CdrWriter out;
  put_gid(out, {participant, dds::fastrtps::c_EntityId_RTPSParticipant}, gid_bytes);
  const std::map<std::string, Endpoints> nodes = nodes_of(process);
  out.put(static_cast<std::uint32_t>(nodes.size()));
  for (const auto& [space, endpoints] : nodes) {
    out.text(space).text(node_name(process.name));
    for (const std::vector<GUID_t>* guids : {&endpoints.readers, &endpoints.writers}) {
      out.put(static_cast<std::uint32_t>(guids->size()));
      for (const GUID_t& guid : *guids) put_gid(out, guid, gid_bytes);
    }
  }
  return out.take();
}

dds::NodeSettings renamed(dds::NodeSettings settings) {
  settings.name = "ros_graph";
  settings.source_of.clear();
  return settings;
}

}  // namespace

class RosGraph::Impl final : public dds::DiscoveryListener {
 public:
  Impl(const dds::NodeSettings& settings, std::size_t gid_bytes)
      : settings_(renamed(settings)),
        gid_bytes_(gid_bytes),
        session_(settings_, rtps::Announcement{}, dds::guard_of(settings_), this),
        topic_(session_.topic(kTopic, fastdds::TypeSupport(new EntitiesType()))),
        task_(std::in_place, kPeriod, [this] { announce_changes(); }) {}
  ~Impl() override { task_.reset(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

 private:
  void on_participant(const GUID_t& guid, const std::string& name,
                      const std::vector<std::uint8_t>& user_data) override {
    if (rtps::from_user_data(user_data).host.empty()) return;  // a program of others, which speaks for itself
    const std::lock_guard<std::mutex> lock(mutex_);
    Process& process = processes_[guid.guidPrefix];
    process.name = name;
    process.changed = true;
  }
  void on_participant_gone(const GUID_t& guid, bool /*said_goodbye*/) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto gone = processes_.find(guid.guidPrefix);
    if (gone == processes_.end()) return;
    if (gone->second.announcer != nullptr) ended_.push_back(gone->second.announcer);
    processes_.erase(gone);
  }
  void on_writer(const GUID_t& guid, const dds::RemoteEndpoint& writer) override {
    add(&Process::writers, guid, writer.topic);
  }
  void on_reader(const GUID_t& guid, const dds::RemoteEndpoint& reader) override {
    add(&Process::readers, guid, reader.topic);
  }
  void on_writer_gone(const GUID_t& guid) override { remove(&Process::writers, guid); }
  void on_reader_gone(const GUID_t& guid) override { remove(&Process::readers, guid); }

  using Topics = std::map<GUID_t, std::string>;
  void add(Topics Process::*topics, const GUID_t& guid, const std::string& topic) {
    if (topic.rfind(kRosPrefix, 0) != 0) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto process = processes_.find(guid.guidPrefix);
    if (process == processes_.end()) return;
    (process->second.*topics)[guid] = topic;
    process->second.changed = true;
  }
  void remove(Topics Process::*topics, const GUID_t& guid) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto process = processes_.find(guid.guidPrefix);
    if (process != processes_.end() && (process->second.*topics).erase(guid) > 0)
      process->second.changed = true;
  }

  // Each process has a writer of its own, whose last message late readers receive: the topic has no keys.
  void announce_changes() {
    std::vector<fastdds::DataWriter*> ended;
    std::vector<std::pair<GuidPrefix_t, Bytes>> changes;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ended.swap(ended_);
      for (auto& [participant, process] : processes_) {
        if (!std::exchange(process.changed, false)) continue;
        changes.emplace_back(participant, entities_message(participant, process, gid_bytes_));
      }
    }
    for (fastdds::DataWriter* announcer : ended) session_.publisher->delete_datawriter(announcer);
    for (auto& [participant, payload] : changes) announce(participant, std::move(payload));
  }

  void announce(const GuidPrefix_t& participant, Bytes payload) {
    fastdds::DataWriter* announcer = nullptr;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const auto process = processes_.find(participant);
      if (process == processes_.end()) return;
      announcer = process->second.announcer;
    }
    if (announcer == nullptr) {
      fastdds::DataWriterQos qos = dds::writer_qos(messages::Qos::kLatchedLarge);
      dds::state_type_hash(qos, ParticipantEntities::kTypeHash);
      announcer = session_.publisher->create_datawriter(topic_, qos);
      if (announcer == nullptr) return runtime::log_error("cannot publish {}", kTopic);
      const std::lock_guard<std::mutex> lock(mutex_);
      const auto process = processes_.find(participant);
      if (process == processes_.end()) {
        ended_.push_back(announcer);
        return;
      }
      process->second.announcer = announcer;
    }
    const Message<ParticipantEntities> message{std::move(payload)};
    dds::write(*announcer, &message);
  }

  const dds::NodeSettings settings_;
  const std::size_t gid_bytes_;
  std::mutex mutex_;  // guards the two below; not held while Fast DDS is called, which calls back
  std::map<GuidPrefix_t, Process> processes_;
  std::vector<fastdds::DataWriter*> ended_;  // announcers of processes that are gone
  dds::ParticipantSession session_;
  fastdds::Topic* topic_;
  std::optional<dds::PeriodicTask> task_;
};

RosGraph::RosGraph(dds::NodeSettings settings, std::size_t gid_bytes)
    : impl_(std::make_unique<Impl>(std::move(settings), gid_bytes)) {}
RosGraph::~RosGraph() = default;

}  // namespace swiftlet::ros
