// The unit that the compiler's CPU seconds are compared with, since computers differ: what they take for this file, which does not
// change. It is compiled several times during a build, beside the other units, and is in no program.
#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Eigenvalues>

namespace swiftlet::weight {

template <int N>
double smallest_eigenvalue(const std::vector<double>& values) {
  Eigen::Matrix<double, N, N> matrix;
  for (int i = 0; i < N * N; ++i) matrix(i / N, i % N) = values[static_cast<std::size_t>(i) % values.size()];
  const Eigen::Matrix<double, N, N> symmetric = matrix + matrix.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(symmetric);
  return solver.eigenvalues()[0];
}

using Value = std::variant<double, std::string, std::vector<double>>;

std::string text_of(const std::map<std::string, std::optional<Value>>& entries) {
  std::ostringstream text;
  for (const auto& [name, value] : entries) {
    text << name << ' ';
    if (!value) continue;
    std::visit(
        [&text](const auto& one) {
          if constexpr (std::is_same_v<std::decay_t<decltype(one)>, std::vector<double>>) {
            for (const double number : one) text << number << ' ';
          } else {
            text << one;
          }
        },
        *value);
  }
  return text.str();
}

double reference(std::vector<double> values) {
  std::stable_sort(values.begin(), values.end(), std::greater<>());
  const auto sum = std::make_shared<double>(0.0);
  const std::function<void(double)> add = [sum](double value) { *sum += value; };
  for (const double value : values) add(value);
  return *sum + smallest_eigenvalue<3>(values) +
         static_cast<double>(text_of({{"values", Value(values)}}).size());
}

}  // namespace swiftlet::weight
