#include "sinew/run/scene_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <string_view>

#include "sinew/scene/document.h"
#include "sinew/scene/keys.h"

namespace sinew {
namespace {

constexpr const char* nothing = "not given";

using Values = std::map<std::string, const DocValue*>;

// Every value of the tree that is no table and no array, by its key.
void collect(const DocValue& value, const std::string& key, Values& out) {
  if (value.type == DocValue::Type::table) {
    for (const DocEntry& e : value.entries)
      collect(e.value, key.empty() ? e.key : key + "." + e.key, out);
    if (value.entries.empty()) out[key] = &value;
  } else if (value.type == DocValue::Type::array) {
    for (std::size_t i = 0; i < value.items.size(); ++i)
      collect(value.items[i], fmt::format("{}[{}]", key, i), out);
    if (value.items.empty()) out[key] = &value;
  } else {
    out[key] = &value;
  }
}

bool is_number(const DocValue& v) {
  return v.type == DocValue::Type::integer || v.type == DocValue::Type::number;
}
double number_of(const DocValue& v) {
  return v.type == DocValue::Type::integer ? static_cast<double>(v.integer) : v.number;
}

bool same(const DocValue& a, const DocValue& b) {
  if (is_number(a) && is_number(b)) return number_of(a) == number_of(b);
  if (a.type != b.type) return false;
  return a.boolean == b.boolean && a.text == b.text;
}

std::string text_of(const DocValue& v) {
  if (is_number(v)) return fmt::format("{}", number_of(v));
  return v.type == DocValue::Type::text ? toml_text(v.text) : describe(v);
}

bool is_default(const std::string& key, const DocValue& value) {
  constexpr std::string_view output = "output.";
  const bool of_output = std::string_view(key).starts_with(output);
  const KeyTable& table = of_output ? key_tables().output : key_tables().scene;
  const Key* known = table.find(of_output ? std::string_view(key).substr(output.size()) : key);
  if (known == nullptr || known->default_value.empty()) return false;
  const std::string text(known->default_value);
  if (!is_number(value)) return text_of(value) == text;
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return *end == '\0' && number == number_of(value);
}

}  // namespace

std::vector<SceneChange> scene_changes(const std::string& before, const std::string& after) {
  const DocValue old_tree = parse_document(before, "checkpoint.bin");
  const DocValue new_tree = parse_document(after, "scene.toml");
  Values old_values, new_values;
  collect(old_tree, "", old_values);
  collect(new_tree, "", new_values);
  std::vector<SceneChange> changes;
  for (const auto& [key, value] : old_values) {
    const auto now = new_values.find(key);
    if (now == new_values.end()) {
      if (!is_default(key, *value)) changes.push_back({key, text_of(*value), nothing});
    } else if (!same(*value, *now->second)) {
      changes.push_back({key, text_of(*value), text_of(*now->second)});
    }
  }
  for (const auto& [key, value] : new_values) {
    if (old_values.count(key) == 0 && !is_default(key, *value))
      changes.push_back({key, nothing, text_of(*value)});
  }
  return changes;
}

bool may_change(const std::string& key) {
  constexpr std::array<std::string_view, 8> free = {
      "duration",          "title",           "look_for",   "output.fps",
      "output.checkpoint", "output.encoding", "output.vtu", "base"};
  return std::find(free.begin(), free.end(), key) != free.end();
}

void require_same_run(const std::vector<SceneChange>& changes, const Scene& scene, double time) {
  constexpr std::size_t most = 5;  // changes that are named
  std::string list;
  std::size_t count = 0;
  for (const SceneChange& c : changes) {
    if (may_change(c.key)) continue;
    if (++count <= most)
      list +=
          fmt::format("{}{} was {}, is now {}", count > 1 ? "; " : "", c.key, c.before, c.after);
  }
  if (count > most) list += fmt::format("; and {} more", count - most);
  if (count > 0)
    throw Error(
        ErrorKind::input, "the scene was edited since the run began: " + list,
        "put the old values back; or run the edited scene into another folder. A run may go "
        "on with another duration, and with other fps, vtu, encoding and checkpoint of "
        "[output]",
        Location{scene.file});
  if (scene.duration < time * (1.0 - 1e-9))
    throw Error(ErrorKind::input,
                fmt::format("'duration' is now {:g} s, and the run has reached {:g} s already",
                            scene.duration, time),
                fmt::format("give a duration of at least {:g} s", time), Location{scene.file});
}

}  // namespace sinew
