// Numbers side by side, two to a register: every processor that this runs on has registers for two doubles,
// and an optimiser left to itself fills them only here and there.
#pragma once

#include <array>

#include <Eigen/Core>

namespace swiftlet::plant {

using Pair = Eigen::Array2d;

inline Pair pair(const double* from) { return Pair(from); }
inline void store(const Pair& pair, double* to) { Pair::Map(to) = pair; }

// (y, -x) of (x, y).
inline Pair clockwise(const Pair& xy) { return {xy[1], -xy[0]}; }

// A vector of three.
struct Triple {
  Pair xy;
  double z;
};

inline Triple triple(const Eigen::Vector3d& v) { return {pair(v.data()), v.z()}; }
inline Eigen::Vector3d vector(const Triple& v) { return {v.xy[0], v.xy[1], v.z}; }

// v + h k
[[gnu::always_inline]] inline Triple moved(const Triple& v, double h, const Triple& k) {
  return {v.xy + h * k.xy, v.z + h * k.z};
}

// A matrix by its columns.
using TripleColumns = std::array<Triple, 3>;

inline TripleColumns columns(const Eigen::Matrix3d& matrix) {
  return {triple(matrix.col(0)), triple(matrix.col(1)), triple(matrix.col(2))};
}

// The matrix times (x, y, z).
[[gnu::always_inline]] inline Triple product(const TripleColumns& columns, double x, double y, double z) {
  return {columns[0].xy * x + columns[1].xy * y + columns[2].xy * z,
          columns[0].z * x + columns[1].z * y + columns[2].z * z};
}

}  // namespace swiftlet::plant
