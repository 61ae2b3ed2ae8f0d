// Devices without hardware: a simulated hand, a recorded path.
#include <fmt/format.h>
#include <sinew/error.h>
#include <sinew/haptics.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "sinew/io/file_io.h"
#include "sinew/sim/mover.h"

namespace sinew {

using sim::point;
using sim::vec;

SimulatedHand::SimulatedHand(HandDescription hand)
    : hand_(std::move(hand)), position_(hand_.start) {
  if (!(hand_.mass > 0.0) || !(hand_.damping >= 0.0) || !(hand_.stiffness >= 0.0) || !hand_.aim)
    throw Error(ErrorKind::usage,
                fmt::format("a hand of {:g} kg, {:g} N s/m and {:g} N/m{}", hand_.mass,
                            hand_.damping, hand_.stiffness, hand_.aim ? "" : ", without an aim"),
                "give a mass above 0, constants of at least 0, and an aim");
}

// Implicit in spring and dashpot, so any constants are stable; the device's force is that of the
// last tick, as it is for a real hand.
HapticInput SimulatedHand::read(double dt) {
  time_ += dt;
  const double k = hand_.stiffness, c = hand_.damping, m = hand_.mass;
  const Vec3 x = vec(position_), v = vec(velocity_);
  const Vec3 push = vec(force_) + k * (vec(hand_.aim(time_)) - x);
  const Vec3 next = (m * v + dt * push) / (m + dt * c + dt * dt * k);
  velocity_ = point(next);
  position_ = point(x + dt * next);
  return {position_, {1.0, 0.0, 0.0, 0.0}, false};
}

void SimulatedHand::write(const Wrench& wrench) {
  force_ = wrench.force;
}

RecordedPath::RecordedPath(std::vector<Row> rows) : rows_(std::move(rows)) {
  if (rows_.empty())
    throw Error(ErrorKind::usage, "a recorded path without rows", "give at least one");
  for (std::size_t i = 1; i < rows_.size(); ++i)
    if (!(rows_[i].time >= rows_[i - 1].time))
      throw Error(ErrorKind::usage,
                  fmt::format("row {} of the path has the time {:g} s, the one before {:g} s",
                              i + 1, rows_[i].time, rows_[i - 1].time),
                  "give the rows in the order of their times");
}

RecordedPath::RecordedPath(RecordedPath&& other) noexcept
    : rows_(std::move(other.rows_)), at_(other.at_), time_(other.time_) {}

RecordedPath RecordedPath::from_file(const std::filesystem::path& file) {
  return from_text(io::read_file(file), file.string());
}

RecordedPath RecordedPath::from_text(std::string_view text, const std::string& name) {
  std::vector<Row> rows;
  std::size_t line_number = 0;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    std::string_view line(text.data() + start, end - start);
    start = end + 1;
    ++line_number;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty() || line[0] == '#') continue;
    std::vector<double> values;
    bool fault = false;
    for (std::size_t at = 0; at <= line.size() && !fault;) {
      const std::size_t comma = std::min(line.find(',', at), line.size());
      while (at < comma && line[at] == ' ') ++at;
      std::size_t last = comma;
      while (last > at && line[last - 1] == ' ') --last;
      double value = 0.0;
      const auto [stop, error] = std::from_chars(line.data() + at, line.data() + last, value);
      fault = error != std::errc() || stop != line.data() + last || !std::isfinite(value);
      values.push_back(value);
      at = comma + 1;
    }
    if (fault && rows.empty() && values.size() == 1) continue;  // the line of names
    const std::string place = fmt::format("{}:{}", name, line_number);
    const std::size_t n = values.size();
    if (fault || (n != 4 && n != 8 && n != 9))
      throw Error(ErrorKind::input,
                  fmt::format("{}: expected time, x, y, z, and perhaps qw, qx, qy, qz, and perhaps "
                              "button, as numbers",
                              place),
                  "give 4, 8 or 9 numbers with commas between them");
    Row row{values[0], {{values[1], values[2], values[3]}, {1.0, 0.0, 0.0, 0.0}, false}};
    if (n >= 8) row.input.rotation = {values[4], values[5], values[6], values[7]};
    if (n == 9) row.input.button = values[8] != 0.0;
    if (n >= 8 && values[4] == 0.0 && values[5] == 0.0 && values[6] == 0.0 && values[7] == 0.0)
      throw Error(ErrorKind::input, fmt::format("{}: the rotation has no length", place),
                  "no rotation is 1, 0, 0, 0: w, x, y, z");
    if (!rows.empty() && row.time < rows.back().time)
      throw Error(ErrorKind::input,
                  fmt::format("{}: time {:g} s after {:g} s", place, row.time, rows.back().time),
                  "sort the rows by their times");
    rows.push_back(row);
  }
  if (rows.empty())
    throw Error(ErrorKind::input, fmt::format("{}: no rows", name), "give rows of time, x, y, z");
  return RecordedPath(std::move(rows));
}

HapticInput RecordedPath::read(double dt) {
  time_ += dt;
  while (at_ + 1 < rows_.size() && rows_[at_ + 1].time <= time_) ++at_;
  const Row& a = rows_[at_];
  if (at_ + 1 == rows_.size() || time_ <= a.time) return a.input;
  const Row& b = rows_[at_ + 1];
  const double s = (time_ - a.time) / (b.time - a.time);
  HapticInput out = a.input;
  for (std::size_t i = 0; i < 3; ++i)
    out.position[i] += s * (b.input.position[i] - a.input.position[i]);
  const auto turn = [](const Quaternion& q) {
    return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  };
  const Eigen::Quaterniond q = turn(a.input.rotation).slerp(s, turn(b.input.rotation));
  out.rotation = {q.w(), q.x(), q.y(), q.z()};
  return out;
}

void RecordedPath::write(const Wrench&) {}

}  // namespace sinew
