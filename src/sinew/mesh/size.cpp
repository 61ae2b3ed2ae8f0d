#include "sinew/mesh/size.h"

#include <fmt/format.h>

#include <cmath>

namespace sinew {
namespace {

// Two significant digits and no exponent: 1.6, 16, 160.
std::string two_digits(double value) {
  if (value >= 9.95) return fmt::format("{:.0f}", value);
  const std::string text = fmt::format("{:.1f}", value);
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

std::string volume_text(double m3) {
  if (m3 >= 1e15) return fmt::format("{:.1e} m3", m3);
  if (m3 >= 1e9) return two_digits(m3 / 1e9) + " billion m3";
  if (m3 >= 1e6) return two_digits(m3 / 1e6) + " million m3";
  if (m3 >= 1e3) return two_digits(m3 / 1e3) + " thousand m3";
  if (m3 >= 1) return two_digits(m3) + " m3";
  return fmt::format("{:.2g} mm3", m3 * 1e9);
}

}  // namespace

std::optional<std::string> size_warning(double volume, const Vec3& extent, double scale) {
  const double size = std::abs(volume);
  const double longest = extent.maxCoeff();
  if (!std::isfinite(size) || !(longest > 0)) return std::nullopt;
  if (size > 10) {
    // The unit with which the size is that of an organ: 3 cm to 3 m.
    const char* unit = "micrometres";
    double factor = 1e-6;
    if (longest < 30) {
      unit = "centimetres";
      factor = 0.01;
    } else if (longest < 3000) {
      unit = "millimetres";
      factor = 0.001;
    }
    return fmt::format("{}: is this mesh in {}? scale = {:g}", volume_text(size), unit,
                       factor * scale);
  }
  if (size < 1e-10) {
    if (scale < 1) {
      return fmt::format("{}: was this mesh in metres already? leave out scale = {:g}",
                         volume_text(size), scale);
    }
    return fmt::format("{}: has this mesh been scaled twice? scale = {:g}", volume_text(size),
                       1000 * scale);
  }
  return std::nullopt;
}

}  // namespace sinew
