#include "sinew/report/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sinew::report {

namespace {

constexpr const char* kMinus = "\u2212";

int exponent_of(double value) {
  return static_cast<int>(std::floor(std::log10(std::abs(value))));
}

std::string power_of_ten(int exponent) {
  static constexpr std::array<const char*, 10> digits = {"\u2070", "\u00b9", "\u00b2", "\u00b3",
                                                         "\u2074", "\u2075", "\u2076", "\u2077",
                                                         "\u2078", "\u2079"};
  std::string out = "10";
  if (exponent < 0) out += "\u207b";
  for (const char digit : std::to_string(std::abs(exponent)))
    out += digits[static_cast<std::size_t>(digit - '0')];
  return out;
}

// A number of so many decimals with a proper minus sign.
std::string decimal(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", std::abs(value), std::max(0, decimals));
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  return (value < 0.0 && !zero ? kMinus : "") + text;
}

// Labels that distinguish values that differ by `step`, all in one notation.
std::vector<std::string> linear_labels(const std::vector<double>& at, double step) {
  double largest = 0.0;
  for (const double value : at) largest = std::max(largest, std::abs(value));
  // The range of numbers that are legible without powers of ten.
  const bool plain = largest < 1e5 && step >= 0.999e-4;
  const int top = largest > 0.0 ? exponent_of(largest * (1.0 + 1e-12)) : 0;
  const int step_exponent = exponent_of(step * (1.0 + 1e-12));
  std::vector<std::string> labels;
  for (const double value : at) {
    if (plain)
      labels.push_back(decimal(value, -step_exponent));
    else if (std::abs(value) < 0.5 * step)
      labels.emplace_back("0");
    else
      labels.push_back(decimal(value / std::pow(10.0, top), top - step_exponent) + "\u00b7" +
                       power_of_ten(top));
  }
  return labels;
}

// The label of m times 10 to the power of e, m one of 1, 2, 5.
std::string log_label(int m, int e, bool plain) {
  if (plain) return decimal(m * std::pow(10.0, e), -e);
  return m == 1 ? power_of_ten(e) : fmt::format("{}\u00b7{}", m, power_of_ten(e));
}

}  // namespace

Ticks linear_ticks(double low, double high, int most) {
  const double rough = (high - low) / std::max(1, most);
  const double power = std::pow(10.0, exponent_of(rough));
  double step = 10.0 * power;
  for (const double m : {5.0, 2.0, 1.0})
    if (m * power >= rough * (1.0 - 1e-9)) step = m * power;
  Ticks ticks;
  const double slack = 1e-9 * (high - low);
  const double first = std::ceil((low - slack) / step);
  for (double n = first; n * step <= high + slack; ++n) ticks.at.push_back(n * step);
  ticks.labels = linear_labels(ticks.at, step);
  return ticks;
}

Ticks log_ticks(double low, double high, int most) {
  const double slack = 1e-9;  // of the logarithm
  const double from = std::log10(low) - slack;
  const double to = std::log10(high) + slack;
  const bool dense = to - from < 3.0;
  const int decades = static_cast<int>(std::floor(to) - std::ceil(from)) + 1;
  const int every = std::max(1, (decades + most - 1) / std::max(1, most));
  struct Tick {
    int m, e;
  };
  std::vector<Tick> found;
  const int last = static_cast<int>(std::floor(to));
  for (int e = static_cast<int>(std::floor(from)); e <= last; ++e) {
    for (const int m : {1, 2, 5}) {
      const double at = e + std::log10(m);
      if (at < from || at > to || (m > 1 && !dense) || e % every != 0) continue;
      found.push_back({m, e});
    }
  }
  if (found.size() < 3) return linear_ticks(low, high, most);
  const bool plain = found.front().e >= -3 && found.back().e <= 4;
  Ticks ticks;
  for (const auto& [m, e] : found) {
    ticks.at.push_back(m * std::pow(10.0, e));
    ticks.labels.push_back(log_label(m, e, plain));
  }
  return ticks;
}

}  // namespace sinew::report
