// Numbers side by side, two to a register: every processor that this runs on has registers for two doubles,
// and an optimiser left to itself fills them only here and there.
#pragma once

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

// A symmetric matrix, by its diagonal and what stands beside that: xy, xz, yz. Mostly nothing does.
struct Symmetric {
  Triple diagonal;
  Triple beside;
  bool is_diagonal;
};

inline Symmetric symmetric(const Eigen::Matrix3d& m) {
  const Eigen::Vector3d beside(m(0, 1), m(0, 2), m(1, 2));
  return {triple(m.diagonal()), triple(beside), beside.isZero(0.0)};
}

// The matrix times v.
[[gnu::always_inline]] inline Triple product(const Symmetric& m, const Triple& v) {
  Triple out = {m.diagonal.xy * v.xy, m.diagonal.z * v.z};
  if (m.is_diagonal) return out;
  const double xy = m.beside.xy[0];
  const double xz = m.beside.xy[1];
  const double yz = m.beside.z;
  out.xy += Pair(xy * v.xy[1] + xz * v.z, xy * v.xy[0] + yz * v.z);
  out.z += xz * v.xy[0] + yz * v.xy[1];
  return out;
}

}  // namespace swiftlet::plant
