// Two recorded flights side by side, topic by topic, in figures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "swiftlet/record/mcap/reader.hpp"
#include "swiftlet/record/mcap/series.hpp"

namespace swiftlet::analysis {

// How far a signal of B lies from that of A: the length of the difference of a vector, the angle between two attitudes
// (rad). At the times of A; B is interpolated linearly between messages at most 1 s apart, a whole number is held.
struct SignalDifference {
  std::string name;  // "position_ned"
  double rms = 0.0;
  double max = 0.0;
  double max_at_s = 0.0;  // time of the largest, from the start of A
};

struct TopicDifference {
  std::string topic;
  std::uint64_t messages_a = 0;
  std::uint64_t messages_b = 0;
  bool equal = false;        // the same messages, byte for byte
  std::size_t compared = 0;  // messages of A that have a counterpart in B
  std::vector<SignalDifference>
      signals;  // unless equal; in the order of the message, without stamps and identifiers
};

// topics: empty for those of swiftlet_msgs, or all that can be decoded if there is none. Times count from the start of
// the vehicle's first mission, in a file without one from the first message of the topic. Throws ConfigError if neither
// file has a topic, or a message does not fit its schema.
std::vector<TopicDifference> difference(const mcap::Reader& a, const mcap::Reader& b,
                                        const std::set<std::string>& topics);

// The signals of one topic in two files. start_a_ns, start_b_ns: the times, by the stamps, that are compared. Sets all but
// `equal`.
TopicDifference difference(const mcap::Series& a, const mcap::Series& b, std::int64_t start_a_ns,
                           std::int64_t start_b_ns);

}  // namespace swiftlet::analysis
