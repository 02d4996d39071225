#include "swiftlet/control/planning/smoothing_spline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace swiftlet::control {
namespace {

constexpr std::size_t kDegree = kPolynomialCoefficients - 1;
constexpr std::size_t kOrder = kDegree + 1;  // B-splines that are not zero in an interval
constexpr int kRoughness = 5;                // order of the derivative whose squared integral is minimal
constexpr double kFirstInterval_s = 0.4;
constexpr double kShortestInterval_s = 1e-3;
constexpr double kRepresentable =
    2.0;  // of the tolerance: greatest residual of a sufficient fit by least squares
constexpr double kLeastSmoothing = 1e-12;  // relative to the samples, in the fit by least squares
constexpr int kMostRefinements = 12;
// The interior-point method:
constexpr int kMaxSteps = 60;
constexpr double kGap = 1e-3;  // relative to the roughness
constexpr double kViolation = kSmoothingPrecision - 1.0;
constexpr double kLeastStep = 1e-3;
constexpr double kStraight = 1e-12;  // m^2/s^9: roughness of rest, but for rounding

using Weights = std::array<double, kOrder>;

// Between breaks_s, with the first and the last of kOrder-fold multiplicity.
class BSplines {
 public:
  explicit BSplines(const std::vector<double>& breaks_s) : breaks_s_(breaks_s) {
    knots_s_.assign(kDegree, breaks_s.front());
    knots_s_.insert(knots_s_.end(), breaks_s.begin(), breaks_s.end());
    knots_s_.insert(knots_s_.end(), kDegree, breaks_s.back());
  }

  std::size_t intervals() const { return breaks_s_.size() - 1; }
  std::size_t count() const { return intervals() + kDegree; }
  double begin_s(std::size_t interval) const { return breaks_s_[interval]; }
  double length_s(std::size_t interval) const { return breaks_s_[interval + 1] - breaks_s_[interval]; }

  std::size_t interval_of(double t_s) const {
    const auto after = std::upper_bound(breaks_s_.begin(), breaks_s_.end(), t_s);
    return std::min(static_cast<std::size_t>(after - breaks_s_.begin()) - 1, intervals() - 1);
  }

  // Derivatives at t_s of the B-splines interval .. interval + kDegree. By de Boor's recurrence in the degree p:
  // B_{i,p} = (t - t_i) / (t_{i+p} - t_i) B_{i,p-1} + (t_{i+p+1} - t) / (t_{i+p+1} - t_{i+1}) B_{i+1,p-1},
  // B'_{i,p} = p / (t_{i+p} - t_i) B_{i,p-1} - p / (t_{i+p+1} - t_{i+1}) B_{i+1,p-1}.
  Weights weights(std::size_t interval, double t_s, std::size_t derivative) const {
    Weights w{1.0};
    for (std::size_t p = 1; p <= kDegree; ++p) {
      Weights next{};
      for (std::size_t k = 0; k < p; ++k) {
        const double low_s = knots_s_[interval + kDegree + 1 + k - p];
        const double high_s = knots_s_[interval + kDegree + 1 + k];
        const double share = w[k] / (high_s - low_s);
        const bool differentiate = p > kDegree - derivative;
        next[k] += share * (differentiate ? -static_cast<double>(p) : high_s - t_s);
        next[k + 1] += share * (differentiate ? static_cast<double>(p) : t_s - low_s);
      }
      w = next;
    }
    return w;
  }

 private:
  std::vector<double> breaks_s_;
  std::vector<double> knots_s_;
};

// A linear function of the coefficients: of the B-splines first .. first + kDegree.
struct Row {
  std::size_t first = 0;
  Weights weights{};
};

// The coefficients of one axis that are free. The first three are equal for a path that begins at rest, and the last
// three for one that ends so.
class Unknowns {
 public:
  Unknowns(std::size_t coefficients, bool rests_at_end)
      : count_(coefficients - kTied - (rests_at_end ? kTied : 0)) {}

  std::size_t count() const { return count_; }
  std::size_t of(std::size_t coefficient) const {
    return std::min(coefficient - std::min(coefficient, kTied), count_ - 1);
  }
  double product(const Row& row, const std::vector<double>& x) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < kOrder; ++k) sum += row.weights[k] * x[of(row.first + k)];
    return sum;
  }
  void add(const Row& row, double factor, std::vector<double>& x) const {
    for (std::size_t k = 0; k < kOrder; ++k) x[of(row.first + k)] += factor * row.weights[k];
  }

 private:
  static constexpr std::size_t kTied = 2;
  std::size_t count_;
};

// Symmetric and positive definite; row i holds the columns i - kDegree .. i.
class BandMatrix {
 public:
  explicit BandMatrix(std::size_t size) : rows_(size, Weights{}) {}

  // Adds factor * row' * row.
  void add(const Row& row, double factor, const Unknowns& unknowns) {
    for (std::size_t a = 0; a < kOrder; ++a) {
      const std::size_t i = unknowns.of(row.first + a);
      for (std::size_t b = 0; b < kOrder; ++b) {
        const std::size_t j = unknowns.of(row.first + b);
        if (j <= i) rows_[i][i - j] += factor * row.weights[a] * row.weights[b];
      }
    }
  }
  void add(const BandMatrix& other, double factor) {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      for (std::size_t k = 0; k < kOrder; ++k) rows_[i][k] += factor * other.rows_[i][k];
    }
  }
  double trace() const {
    double sum = 0.0;
    for (const Weights& row : rows_) sum += row[0];
    return sum;
  }

  // By Cholesky's decomposition L D L', which replaces the matrix.
  std::vector<double> solve(std::vector<double> x) && {
    constexpr double kRidge = 1e-14;  // relative: for unknowns that nothing determines
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      Weights& row = rows_[i];
      row[0] *= 1.0 + kRidge;
      const std::size_t band = std::min(i, kDegree);
      for (std::size_t k = band; k > 0; --k) {  // L_ij D_j, j = i - k
        const Weights& other = rows_[i - k];
        for (std::size_t m = k + 1; m <= band; ++m) row[k] -= row[m] * other[m - k];
      }
      for (std::size_t k = band; k > 0; --k) {
        const double scaled = row[k] / rows_[i - k][0];
        row[0] -= scaled * row[k];
        row[k] = scaled;
      }
      for (std::size_t k = 1; k <= band; ++k) x[i] -= row[k] * x[i - k];
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) x[i] /= rows_[i][0];
    for (std::size_t i = rows_.size(); i-- > 0;) {
      for (std::size_t k = 1; k <= std::min(i, kDegree); ++k) x[i - k] -= rows_[i][k] * x[i];
    }
    return x;
  }

 private:
  std::vector<Weights> rows_;
};

// The knots of all axes, and the rows that samples and roughness have on them.
struct Grid {
  BSplines splines;
  std::vector<std::size_t> intervals;  // of each sample
  std::vector<Row> samples;
  std::vector<Row> roughness;  // the sum of squares of its products is the integral
};

Grid grid_of(const std::vector<double>& breaks_s, const std::vector<SplineSample>& samples) {
  Grid grid{BSplines(breaks_s), {}, {}, {}};
  for (const SplineSample& sample : samples) {
    const std::size_t interval = grid.splines.interval_of(sample.time_s);
    grid.intervals.push_back(interval);
    grid.samples.push_back({interval, grid.splines.weights(interval, sample.time_s,
                                                           static_cast<std::size_t>(sample.derivative))});
  }
  // Gauss and Legendre's rule of three points, exact for the squared second degree.
  const std::array<std::pair<double, double>, 3> rule = {
      {{0.5 - std::sqrt(0.15), 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.5 + std::sqrt(0.15), 5.0 / 18.0}}};
  for (std::size_t interval = 0; interval < grid.splines.intervals(); ++interval) {
    const double length_s = grid.splines.length_s(interval);
    for (const auto& [place, weight] : rule) {
      Row row{interval,
              grid.splines.weights(interval, grid.splines.begin_s(interval) + place * length_s, kRoughness)};
      for (double& w : row.weights) w *= std::sqrt(weight * length_s);
      grid.roughness.push_back(row);
    }
  }
  return grid;
}

// The fit of one axis.
class AxisFit {
 public:
  AxisFit(const Grid& grid, const std::vector<SplineSample>& samples, int axis, bool rests_at_end)
      : grid_(grid),
        unknowns_(grid.splines.count(), rests_at_end),
        roughness_(unknowns_.count()),
        x_(unknowns_.count(), 0.0) {
    for (const Row& row : grid.roughness) roughness_.add(row, 1.0, unknowns_);
    for (const SplineSample& sample : samples) {
      scale_.push_back(1.0 / sample.tolerance[axis]);
      value_.push_back(sample.value[axis]);
    }
  }

  // Least squares of the residuals over their tolerances.
  void fit_least_squares() {
    BandMatrix matrix(unknowns_.count());
    std::vector<double> right(unknowns_.count(), 0.0);
    for (std::size_t i = 0; i < value_.size(); ++i) {
      const double weight = scale_[i] * scale_[i];
      matrix.add(grid_.samples[i], weight, unknowns_);
      unknowns_.add(grid_.samples[i], weight * value_[i], right);
    }
    matrix.add(roughness_, kLeastSmoothing * matrix.trace() / roughness_.trace());
    x_ = std::move(matrix).solve(std::move(right));
  }

  // The smoothest spline inside the tolerances: a quadratic program, min |G x|^2 / 2 with |scale (a'x - value)| <= 1, by
  // a primal-dual interior-point method (Nocedal and Wright, "Numerical Optimization", 2006, section 16.6). The
  // start is the fit by least squares. Without a solution the result exceeds the tolerances.
  void fit_smoothest() {
    InteriorPoint at = start();
    if (at.roughness <= kStraight && greatest_residual() <= 1.0) return;
    for (int step = 0; step < kMaxSteps; ++step) {
      if (at.gap() <= kGap * at.roughness && at.greatest_violation() < kViolation) return;
      if (!improve(at)) return;
    }
  }

  // Over the tolerance.
  double residual(std::size_t sample) const { return std::abs(signed_residual(sample)); }
  double greatest_residual() const {
    double greatest = 0.0;
    for (std::size_t i = 0; i < value_.size(); ++i) greatest = std::max(greatest, residual(i));
    return greatest;
  }

  // c[k] = s^(k) / k! at the begin of the interval.
  Polynomial polynomial(std::size_t interval) const {
    Polynomial c{};
    double factorial = 1.0;
    for (std::size_t k = 0; k < c.size(); ++k) {
      if (k > 1) factorial *= static_cast<double>(k);
      const Row row{interval, grid_.splines.weights(interval, grid_.splines.begin_s(interval), k)};
      c[k] = unknowns_.product(row, x_) / factorial;
    }
    return c;
  }

 private:
  double signed_residual(std::size_t sample) const {
    return scale_[sample] * (unknowns_.product(grid_.samples[sample], x_) - value_[sample]);
  }
  std::vector<double> products(const std::vector<Row>& rows, const std::vector<double>& x) const {
    std::vector<double> out;
    out.reserve(rows.size());
    for (const Row& row : rows) out.push_back(unknowns_.product(row, x));
    return out;
  }

  // The upper and the lower bound of each sample: slack > 0, multiplier > 0, and by how much residual and slack differ.
  struct Bound {
    double slack = 1.0;
    double multiplier = 0.0;
    double violation = 0.0;

    double stiffness() const { return multiplier / slack; }
  };
  struct InteriorPoint {
    std::vector<std::array<Bound, 2>> bounds;
    double roughness = 0.0;

    double gap() const {
      double sum = 0.0;
      for (const auto& pair : bounds) {
        for (const Bound& bound : pair) sum += bound.slack * bound.multiplier;
      }
      return sum;
    }
    double greatest_violation() const {
      double greatest = 0.0;
      for (const auto& pair : bounds) {
        for (const Bound& bound : pair) greatest = std::max(greatest, std::abs(bound.violation));
      }
      return greatest;
    }
  };
  static constexpr std::array<double, 2> kSide = {1.0, -1.0};  // upper, lower

  void measure(InteriorPoint& at) const {
    at.roughness = 0.0;
    for (const double r : products(grid_.roughness, x_)) at.roughness += 0.5 * r * r;
    for (std::size_t i = 0; i < value_.size(); ++i) {
      for (std::size_t side = 0; side < 2; ++side) {
        Bound& bound = at.bounds[i][side];
        bound.violation = bound.slack + kSide[side] * signed_residual(i) - 1.0;
      }
    }
  }

  InteriorPoint start() const {
    constexpr double kLeastSlack = 0.1;
    InteriorPoint at;
    at.bounds.resize(value_.size());
    measure(at);
    const double each = at.roughness / static_cast<double>(value_.size());
    for (auto& pair : at.bounds) {
      for (Bound& bound : pair) {
        bound.slack = std::max(bound.slack - bound.violation, kLeastSlack);
        bound.multiplier = each / bound.slack;
      }
    }
    measure(at);
    return at;
  }

  // One step of the method; false if it no longer gets ahead.
  bool improve(InteriorPoint& at) {
    constexpr double kCentering = 0.15;
    const double target = kCentering * at.gap() / (2.0 * static_cast<double>(value_.size()));
    BandMatrix matrix(roughness_);
    std::vector<double> down(unknowns_.count(), 0.0);
    for (const Row& row : grid_.roughness) unknowns_.add(row, -unknowns_.product(row, x_), down);
    for (std::size_t i = 0; i < value_.size(); ++i) {
      double stiffness = 0.0;
      double force = 0.0;
      for (std::size_t side = 0; side < 2; ++side) {
        const Bound& bound = at.bounds[i][side];
        stiffness += bound.stiffness();
        force += kSide[side] * (target / bound.slack + bound.stiffness() * bound.violation);
      }
      matrix.add(grid_.samples[i], stiffness * scale_[i] * scale_[i], unknowns_);
      unknowns_.add(grid_.samples[i], -scale_[i] * force, down);
    }
    const std::vector<double> change = std::move(matrix).solve(std::move(down));
    std::vector<std::array<Bound, 2>> changes(value_.size());
    double primal = 1.0;
    double dual = 1.0;
    constexpr double kToBoundary = 0.99;
    for (std::size_t i = 0; i < value_.size(); ++i) {
      const double moved = scale_[i] * unknowns_.product(grid_.samples[i], change);
      for (std::size_t side = 0; side < 2; ++side) {
        const Bound& bound = at.bounds[i][side];
        Bound& by = changes[i][side];
        by.slack = -bound.violation - kSide[side] * moved;
        by.multiplier = target / bound.slack - bound.multiplier - bound.stiffness() * by.slack;
        if (by.slack < 0.0) primal = std::min(primal, -kToBoundary * bound.slack / by.slack);
        if (by.multiplier < 0.0) dual = std::min(dual, -kToBoundary * bound.multiplier / by.multiplier);
      }
    }
    const double step = std::min(primal, dual);
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += step * change[i];
    for (std::size_t i = 0; i < value_.size(); ++i) {
      for (std::size_t side = 0; side < 2; ++side) {
        at.bounds[i][side].slack += step * changes[i][side].slack;
        at.bounds[i][side].multiplier += step * changes[i][side].multiplier;
      }
    }
    measure(at);
    return step > kLeastStep;
  }

  const Grid& grid_;
  Unknowns unknowns_;
  BandMatrix roughness_;
  std::vector<double> x_;
  std::vector<double> scale_, value_;
};

using Axes = std::vector<AxisFit>;

Axes axes_on(const Grid& grid, const std::vector<SplineSample>& samples, bool rests_at_end) {
  Axes axes;
  for (int axis = 0; axis < 4; ++axis) axes.emplace_back(grid, samples, axis, rests_at_end);
  return axes;
}

// Splits the intervals with a residual above `limit`, the worst first. Returns false if there is none that may be split.
bool refine(const Grid& grid, const Axes& axes, double limit, std::size_t max_segments,
            std::vector<double>& breaks_s) {
  std::vector<double> worst(grid.splines.intervals(), 0.0);
  for (std::size_t i = 0; i < grid.samples.size(); ++i) {
    for (const AxisFit& axis : axes) {
      double& value = worst[grid.intervals[i]];
      value = std::max(value, axis.residual(i));
    }
  }
  std::vector<std::pair<double, std::size_t>> candidates;
  for (std::size_t i = 0; i < worst.size(); ++i) {
    if (worst[i] > limit && grid.splines.length_s(i) > 2.0 * kShortestInterval_s)
      candidates.emplace_back(worst[i], i);
  }
  std::sort(candidates.rbegin(), candidates.rend());
  const std::size_t room = max_segments - std::min(max_segments, worst.size());
  candidates.resize(std::min(candidates.size(), room));
  for (const auto& [residual, interval] : candidates)
    breaks_s.push_back(grid.splines.begin_s(interval) + 0.5 * grid.splines.length_s(interval));
  std::sort(breaks_s.begin(), breaks_s.end());
  return !candidates.empty();
}

std::vector<double> even_breaks(double begin_s, double end_s, std::size_t intervals) {
  std::vector<double> breaks_s;
  for (std::size_t i = 0; i < intervals; ++i)
    breaks_s.push_back(begin_s + (end_s - begin_s) * static_cast<double>(i) / static_cast<double>(intervals));
  breaks_s.push_back(end_s);
  return breaks_s;
}

}  // namespace

SmoothedPath smoothing_spline(const std::vector<SplineSample>& samples, bool rests_at_end,
                              std::size_t max_segments) {
  const double begin_s = samples.front().time_s;
  const double duration_s = samples.back().time_s - begin_s;
  const auto first = static_cast<std::size_t>(std::ceil(duration_s / kFirstInterval_s));
  std::vector<double> breaks_s =
      even_breaks(begin_s, samples.back().time_s, std::clamp(first, kMinSmoothedSegments, max_segments));
  for (int i = 0; i < kMostRefinements; ++i) {
    const Grid grid = grid_of(breaks_s, samples);
    Axes axes = axes_on(grid, samples, rests_at_end);
    for (AxisFit& axis : axes) axis.fit_least_squares();
    if (!refine(grid, axes, kRepresentable, max_segments, breaks_s)) break;
  }
  for (int i = 0;; ++i) {
    const Grid grid = grid_of(breaks_s, samples);
    Axes axes = axes_on(grid, samples, rests_at_end);
    double greatest = 0.0;
    for (AxisFit& axis : axes) {
      axis.fit_least_squares();
      axis.fit_smoothest();
      greatest = std::max(greatest, axis.greatest_residual());
    }
    if (greatest > kSmoothingPrecision && i < kMostRefinements &&
        refine(grid, axes, kSmoothingPrecision, max_segments, breaks_s))
      continue;
    SmoothedPath path;
    path.tolerance_use = greatest;
    for (std::size_t k = 0; k < grid.splines.intervals(); ++k) {
      path.segments.push_back({grid.splines.length_s(k), axes[0].polynomial(k), axes[1].polynomial(k),
                               axes[2].polynomial(k), axes[3].polynomial(k)});
    }
    return path;
  }
}

}  // namespace swiftlet::control
