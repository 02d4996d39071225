// The tree behind ConfigNode: what a file holds, and which of its keys the program has read.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "swiftlet/io/config.hpp"

namespace swiftlet::io {

enum class NodeKind { kMissing, kNull, kScalar, kList, kMap };

struct ConfigNode::Value {
  NodeKind kind = NodeKind::kNull;
  int line = 0;
  std::string key;  // from the root
  std::string scalar;
  bool quoted = false;
  std::vector<std::unique_ptr<Value>> children;
  std::vector<std::string> names;      // keys of a map's children
  std::vector<std::string> read_keys;  // keys that the program has read
  bool open = false;                   // entries() has read all keys

  std::string describe() const;
  Value* child(const std::string& name) const {
    const auto it = std::find(names.begin(), names.end(), name);
    return it == names.end() ? nullptr : children[static_cast<std::size_t>(it - names.begin())].get();
  }

  void mark_read(const std::string& name) {
    if (std::find(read_keys.begin(), read_keys.end(), name) == read_keys.end()) read_keys.push_back(name);
  }
};

struct ConfigNode::Tree {
  std::string file;
  std::unique_ptr<Value> root;
  bool collects_missing = false;  // in read_known()
  std::deque<Value> missing;      // keys that were missing in it, in the order of reading
};

}  // namespace swiftlet::io
