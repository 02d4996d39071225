#include "swiftlet/analysis/logs/log_diff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/record/mcap/series.hpp"
#include "swiftlet/record/mcap/signal_arrays.hpp"
#include "swiftlet/record/mcap/topic_decoder.hpp"
#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::analysis {
namespace {

using mcap::Series;

constexpr std::int64_t kLongestGap_ns = 1'000'000'000;
constexpr double kSecondsPerNs = 1e-9;

std::optional<Series> series_of(const mcap::Reader& file, const std::string& topic) {
  const bool known = std::any_of(file.channels().begin(), file.channels().end(),
                                 [&](const auto& channel) { return channel.second.topic == topic; });
  if (!known) return std::nullopt;
  mcap::Selection selection;
  selection.topics = {topic};
  return mcap::read_series(file, selection).at(topic);
}

std::set<std::string> compared_topics(const mcap::Reader& a, const mcap::Reader& b) {
  std::set<std::string> own;
  std::set<std::string> all;
  for (const mcap::Reader* const file : {&a, &b}) {
    for (const auto& [id, channel] : file->channels()) {
      const auto count = file->statistics().messages_by_channel.find(id);
      if (!mcap::is_decodable(*file, channel) || count == file->statistics().messages_by_channel.end() ||
          count->second == 0)
        continue;
      all.insert(channel.topic);
      if (file->schema_of(channel)->name.rfind("swiftlet_msgs/", 0) == 0) own.insert(channel.topic);
    }
  }
  return own.empty() ? all : own;
}

// When the vehicle of a topic starts its first mission, by its own clock.
std::optional<std::int64_t> mission_start_ns(const mcap::Reader& file, const std::string& topic) {
  const std::string status = topic.substr(0, topic.rfind('/') + 1) + messages::topics::kMissionStatus.name;
  const std::optional<Series> series = series_of(file, status);
  if (!series || !series->has_numbers("state")) return std::nullopt;
  const std::vector<double>& state = series->numbers("state");
  const auto running =
      std::find(state.begin(), state.end(), double{messages::msg::MissionStatus_Constants::RUNNING});
  if (running == state.end()) return std::nullopt;
  return series->stamp_ns()[static_cast<std::size_t>(running - state.begin())];
}

// The starts of vehicles, each looked up once.
class Starts {
 public:
  explicit Starts(const mcap::Reader& file) : file_(file) {}

  std::int64_t of(const Series& series) {
    const std::string vehicle = series.topic().substr(0, series.topic().rfind('/'));
    auto found = starts_.find(vehicle);
    if (found == starts_.end())
      found = starts_.emplace(vehicle, mission_start_ns(file_, series.topic())).first;
    if (found->second) return *found->second;
    return series.size() == 0 ? 0 : series.stamp_ns().front();
  }

 private:
  const mcap::Reader& file_;
  std::map<std::string, std::optional<std::int64_t>> starts_;
};

bool equal_messages(const mcap::Reader& a, const mcap::Reader& b, const std::string& topic) {
  mcap::Selection selection;
  selection.topics = {topic};
  mcap::Messages in_a(a, selection);
  mcap::Messages in_b(b, selection);
  while (in_a.next()) {
    if (!in_b.next()) return false;
    const mcap::ByteView one = in_a.message().payload;
    const mcap::ByteView other = in_b.message().payload;
    if (one.size != other.size || !std::equal(one.data, one.data + one.size, other.data)) return false;
  }
  return !in_b.next();
}

// Differs between any two flights.
bool is_identifier(const std::string& name) {
  constexpr std::array kNames = {"client",       "id",          "controller",      "mission_id",   "term",
                                 "command_term", "request_ids", "request_clients", "settings_name"};
  const auto ends_with = [&](const std::string& end) {
    return name.size() >= end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
  };
  const std::size_t dot = name.rfind('.');
  const std::string last = dot == std::string::npos ? name : name.substr(dot + 1);
  return ends_with("_ns") || ends_with("sequence_number") || name.find("lockstep.") != std::string::npos ||
         std::find(kNames.begin(), kNames.end(), last) != kNames.end();
}

bool is_attitude(const mcap::SignalArray& signal) {
  return signal.count == 4 && (signal.name.rfind("q_", 0) == 0 || signal.name == "attitude_setpoint");
}

// Where the rows of a series lie in time. Rows of a stamp that does not rise are left out.
struct TimedRow {
  std::int64_t time_ns = 0;
  std::size_t row = 0;
};
std::vector<TimedRow> timed_rows(const Series& series, std::int64_t start_ns) {
  std::vector<TimedRow> rows;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::int64_t time_ns = series.stamp_ns()[i] - start_ns;
    if (rows.empty() || time_ns > rows.back().time_ns) rows.push_back({time_ns, i});
  }
  return rows;
}

// A row of A, and the rows of B around it.
struct Match {
  std::int64_t time_ns = 0;
  std::size_t a = 0;
  std::size_t b = 0;
  std::size_t next_b = 0;
  double share = 0.0;  // of next_b
};

std::vector<Match> matches_of(const std::vector<TimedRow>& a, const std::vector<TimedRow>& b) {
  std::vector<Match> matches;
  std::size_t j = 0;
  for (const TimedRow& row : a) {
    while (j + 1 < b.size() && b[j + 1].time_ns <= row.time_ns) ++j;
    if (j >= b.size() || b[j].time_ns > row.time_ns) continue;
    if (b[j].time_ns == row.time_ns) {
      matches.push_back({row.time_ns, row.row, b[j].row, b[j].row, 0.0});
    } else if (j + 1 < b.size() && b[j + 1].time_ns - b[j].time_ns <= kLongestGap_ns) {
      const double share = static_cast<double>(row.time_ns - b[j].time_ns) /
                           static_cast<double>(b[j + 1].time_ns - b[j].time_ns);
      matches.push_back({row.time_ns, row.row, b[j].row, b[j + 1].row, share});
    }
  }
  return matches;
}

using ColumnsOfSignal = std::vector<const std::vector<double>*>;

ColumnsOfSignal columns_of(const Series& series, const mcap::SignalArray& signal) {
  ColumnsOfSignal columns;
  for (std::size_t i = 0; i < signal.count; ++i) {
    const bool indexed = !series.has_numbers(signal.name);
    columns.push_back(&series.numbers(indexed ? signal.name + "[" + std::to_string(i) + "]" : signal.name));
  }
  return columns;
}

double angle_between(const ColumnsOfSignal& a, const ColumnsOfSignal& b, const Match& match) {
  std::array<double, 4> p{};
  std::array<double, 4> q{};
  double p_dot_p = 0.0;
  double q_dot_q = 0.0;
  double ends = 0.0;  // the two quaternions of B may have opposite signs
  for (std::size_t i = 0; i < 4; ++i) ends += (*b[i])[match.b] * (*b[i])[match.next_b];
  const double sign = ends < 0.0 ? -1.0 : 1.0;
  for (std::size_t i = 0; i < 4; ++i) {
    p[i] = (*a[i])[match.a];
    q[i] = (1.0 - match.share) * (*b[i])[match.b] + match.share * sign * (*b[i])[match.next_b];
    p_dot_p += p[i] * p[i];
    q_dot_q += q[i] * q[i];
  }
  // Twice the angle of the quaternions, from the lengths of their difference and sum: exact for small ones.
  const double p_length = std::sqrt(p_dot_p);
  const double q_length = std::sqrt(q_dot_q);
  double minus = 0.0;
  double plus = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    minus += std::pow(p[i] / p_length - q[i] / q_length, 2);
    plus += std::pow(p[i] / p_length + q[i] / q_length, 2);
  }
  const double between = 2.0 * std::atan2(std::sqrt(std::min(minus, plus)), std::sqrt(std::max(minus, plus)));
  return 2.0 * between;
}

double distance(const ColumnsOfSignal& a, const ColumnsOfSignal& b, const Match& match, bool held) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double before = (*b[i])[match.b];
    const double at =
        held || match.share == 0.0 ? before : before + match.share * ((*b[i])[match.next_b] - before);
    sum += std::pow((*a[i])[match.a] - at, 2);
  }
  return std::sqrt(sum);
}

std::optional<SignalDifference> compare(const Series& a, const Series& b, const mcap::SignalArray& signal,
                                        const std::vector<Match>& matches) {
  const ColumnsOfSignal in_a = columns_of(a, signal);
  const ColumnsOfSignal in_b = columns_of(b, signal);
  const bool held = signal.kind != mcap::Column::Kind::kFloat;
  SignalDifference difference;
  difference.name = signal.name;
  double squares = 0.0;
  std::size_t count = 0;
  for (const Match& match : matches) {
    const double apart =
        is_attitude(signal) ? angle_between(in_a, in_b, match) : distance(in_a, in_b, match, held);
    if (!std::isfinite(apart)) continue;  // not known in one of the flights
    ++count;
    squares += apart * apart;
    if (apart > difference.max) {
      difference.max = apart;
      difference.max_at_s = static_cast<double>(match.time_ns) * kSecondsPerNs;
    }
  }
  if (count == 0) return std::nullopt;
  difference.rms = std::sqrt(squares / static_cast<double>(count));
  return difference;
}

// The signals that both have.
std::vector<mcap::SignalArray> common_signals(const Series& a, const Series& b) {
  std::vector<mcap::SignalArray> signals = mcap::signal_arrays(a.columns());
  const std::vector<mcap::SignalArray> others = mcap::signal_arrays(b.columns());
  const auto only_in_a = [&](const mcap::SignalArray& signal) {
    return std::none_of(others.begin(), others.end(), [&](const mcap::SignalArray& other) {
      return other.name == signal.name && other.count == signal.count && other.kind == signal.kind;
    });
  };
  const auto left_out = [&](const mcap::SignalArray& signal) {
    return signal.kind == mcap::Column::Kind::kText || is_identifier(signal.name) || only_in_a(signal);
  };
  signals.erase(std::remove_if(signals.begin(), signals.end(), left_out), signals.end());
  return signals;
}

}  // namespace

std::vector<TopicDifference> difference(const mcap::Reader& a, const mcap::Reader& b,
                                        const std::set<std::string>& topics) {
  Starts starts_a(a);
  Starts starts_b(b);
  std::vector<TopicDifference> differences;
  for (const std::string& topic : topics.empty() ? compared_topics(a, b) : topics) {
    const std::optional<Series> in_a = series_of(a, topic);
    const std::optional<Series> in_b = series_of(b, topic);
    if (!in_a && !in_b) throw io::ConfigError(a.name(), 0, topic, "is in neither of the files");
    TopicDifference now;
    now.topic = topic;
    if (in_a && in_b) {
      now.equal = equal_messages(a, b, topic);
      if (!now.equal) now = difference(*in_a, *in_b, starts_a.of(*in_a), starts_b.of(*in_b));
    }
    now.messages_a = in_a ? in_a->size() : 0;
    now.messages_b = in_b ? in_b->size() : 0;
    differences.push_back(std::move(now));
  }
  return differences;
}

TopicDifference difference(const Series& a, const Series& b, std::int64_t start_a_ns,
                           std::int64_t start_b_ns) {
  TopicDifference now;
  now.topic = a.topic();
  now.messages_a = a.size();
  now.messages_b = b.size();
  const std::vector<Match> matches = matches_of(timed_rows(a, start_a_ns), timed_rows(b, start_b_ns));
  now.compared = matches.size();
  for (const mcap::SignalArray& signal : common_signals(a, b)) {
    if (const auto found = compare(a, b, signal, matches)) now.signals.push_back(*found);
  }
  return now;
}

}  // namespace swiftlet::analysis
