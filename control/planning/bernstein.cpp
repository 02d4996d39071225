#include "swiftlet/control/planning/bernstein.hpp"

#include <algorithm>
#include <cstddef>

namespace swiftlet::control {
namespace {

constexpr std::size_t kSize = kMaxBernsteinDegree + 1;

constexpr std::array<std::array<double, kSize>, kSize> pascal() {
  std::array<std::array<double, kSize>, kSize> rows{};
  for (std::size_t n = 0; n < kSize; ++n) {
    rows[n][0] = 1.0;
    for (std::size_t k = 1; k <= n; ++k) rows[n][k] = rows[n - 1][k - 1] + (k < n ? rows[n - 1][k] : 0.0);
  }
  return rows;
}
constexpr auto kChoose = pascal();  // kChoose[n][k] = n over k

std::size_t index(int i) { return static_cast<std::size_t>(i); }

// The same polynomial with its degree raised by one.
Bernstein raised(const Bernstein& a) {
  Bernstein out;
  out.degree = a.degree + 1;
  const double n = out.degree;
  out.c[0] = a.c[0];
  for (int i = 1; i < out.degree; ++i)
    out.c[index(i)] = (i / n) * a.c[index(i - 1)] + (1.0 - i / n) * a.c[index(i)];
  out.c[index(out.degree)] = a.c[index(a.degree)];
  return out;
}

Bernstein sum(Bernstein a, Bernstein b, double factor) {
  while (a.degree < b.degree) a = raised(a);
  while (b.degree < a.degree) b = raised(b);
  for (int i = 0; i <= a.degree; ++i) a.c[index(i)] += factor * b.c[index(i)];
  return a;
}

// Leaves the right half in `a`.
Bernstein split_off_left(Bernstein& a) {
  Bernstein left;
  left.degree = a.degree;
  for (int k = 0; k <= a.degree; ++k) {
    left.c[index(k)] = a.c[0];
    for (int i = 0; i < a.degree - k; ++i) a.c[index(i)] = 0.5 * (a.c[index(i)] + a.c[index(i + 1)]);
  }
  return left;
}

// Branch and bound with de Casteljau's subdivision.
class MaximumSearch {
 public:
  MaximumSearch(const Bernstein& polynomial, double tolerance)
      : tolerance_(tolerance), attained_(polynomial.c[0]), best_{polynomial.c[0], 0.0} {
    search(polynomial, 0.0, 1.0);
  }
  const Extremum& best() const { return best_; }

 private:
  void update_best(double value, double at) {
    if (value <= attained_) return;
    attained_ = value;
    best_ = {std::max(best_.value, value), at};
  }

  void search(Bernstein part, double from, double width) {
    update_best(part.c[0], from);
    update_best(part.c[index(part.degree)], from + width);
    if (!(part.greatest() > best_.value + tolerance_)) return;
    if (subdivisions_ == kMaxSubdivisions) {
      best_.value = std::max(best_.value, part.greatest());
      return;
    }
    ++subdivisions_;
    const Bernstein left = split_off_left(part);
    const double half = 0.5 * width;
    if (left.greatest() > part.greatest()) {
      search(left, from, half);
      search(part, from + half, half);
    } else {
      search(part, from + half, half);
      search(left, from, half);
    }
  }

  double tolerance_;
  int subdivisions_ = 0;
  double attained_;  // at best_.at; less than best_.value only if the subdivisions did not suffice
  Extremum best_;
};

}  // namespace

double Bernstein::greatest() const { return *std::max_element(c.begin(), c.begin() + degree + 1); }
double Bernstein::least() const { return *std::min_element(c.begin(), c.begin() + degree + 1); }

Bernstein bernstein(const Polynomial& polynomial, double duration_s, int derivative) {
  // Coefficients of the derivative in powers of u.
  Polynomial a{};
  const int degree = kPolynomialCoefficients - 1 - derivative;
  double scale = 1.0;
  for (int i = 0; i <= degree; ++i) {
    double factor = scale;
    for (int j = 1; j <= derivative; ++j) factor *= i + j;
    a[index(i)] = factor * polynomial[index(i + derivative)];
    scale *= duration_s;
  }
  Bernstein out;
  out.degree = degree;
  for (int k = 0; k <= degree; ++k) {
    for (int i = 0; i <= k; ++i)
      out.c[index(k)] += kChoose[index(k)][index(i)] / kChoose[index(degree)][index(i)] * a[index(i)];
  }
  return out;
}

Bernstein constant(double value) {
  Bernstein out;
  out.c[0] = value;
  return out;
}

Bernstein operator+(const Bernstein& a, const Bernstein& b) { return sum(a, b, 1.0); }
Bernstein operator-(const Bernstein& a, const Bernstein& b) { return sum(a, b, -1.0); }

Bernstein operator*(double factor, const Bernstein& a) {
  Bernstein out = a;
  for (int i = 0; i <= out.degree; ++i) out.c[index(i)] *= factor;
  return out;
}

Bernstein operator*(const Bernstein& a, const Bernstein& b) {
  Bernstein out;
  out.degree = a.degree + b.degree;
  for (int i = 0; i <= a.degree; ++i) {
    for (int j = 0; j <= b.degree; ++j) {
      out.c[index(i + j)] += kChoose[index(a.degree)][index(i)] * kChoose[index(b.degree)][index(j)] *
                             a.c[index(i)] * b.c[index(j)];
    }
  }
  for (int k = 0; k <= out.degree; ++k) out.c[index(k)] /= kChoose[index(out.degree)][index(k)];
  return out;
}

Extremum maximum(const Bernstein& polynomial, double tolerance) {
  return MaximumSearch(polynomial, tolerance).best();
}

Extremum minimum(const Bernstein& polynomial, double tolerance) {
  const Extremum of_negative = maximum(-1.0 * polynomial, tolerance);
  return {-of_negative.value, of_negative.at};
}

}  // namespace swiftlet::control
