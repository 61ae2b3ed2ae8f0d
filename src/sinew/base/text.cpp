#include "sinew/base/text.h"

#include <algorithm>
#include <vector>

namespace sinew {
namespace {

// Optimal string alignment distance (Damerau 1964, Levenshtein 1966).
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(above);
    above.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
  }
  return row.back();
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

std::string nearest(std::string_view word, std::span<const std::string_view> known) {
  constexpr std::size_t shortest_stem = 4;
  const std::string wanted = lower_case(word);
  std::string best;
  std::size_t fewest = 0;
  for (const std::string_view candidate : known) {
    const std::string name = lower_case(candidate);
    const std::size_t shorter = std::min(wanted.size(), name.size());
    const std::size_t longer = std::max(wanted.size(), name.size());
    if (shorter == 0) continue;
    // A word of one or two letters allows one edit as well, as long as a letter stays.
    const std::size_t allowed = std::min(std::max<std::size_t>(longer / 3, 1), longer - 1);
    if (longer - shorter > allowed) continue;
    const std::size_t count = edits(wanted, name);
    if (count <= allowed && (best.empty() || count < fewest)) {
      best = candidate;
      fewest = count;
    }
  }
  if (!best.empty()) return best;
  for (const std::string_view candidate : known) {
    const std::string name = lower_case(candidate);
    if (std::min(name.size(), wanted.size()) < shortest_stem) continue;
    if (wanted.starts_with(name) || name.starts_with(wanted)) return std::string(candidate);
  }
  return {};
}

}  // namespace sinew
