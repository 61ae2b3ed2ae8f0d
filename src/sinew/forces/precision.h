// The precision of the material's forces, and its names in scenes.
#pragma once

#include <array>

#include "sinew/base/words.h"

namespace sinew {

// The precision of the forces of tets and springs.
enum class Precision { single, double_ };
constexpr std::array<Word<Precision>, 2> words_of(Precision) {
  return {{{Precision::single, "single"}, {Precision::double_, "double"}}};
}

}  // namespace sinew
