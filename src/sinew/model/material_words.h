// The names of a material's options in scenes.
#pragma once

#include <array>

#include "sinew/base/words.h"
#include "sinew/model/material.h"

namespace sinew {

constexpr std::array<Word<Law>, 5> words_of(Law) {
  return {{{Law::neo_hookean, "neo-hookean"},
           {Law::calibrated, "calibrated"},
           {Law::uniform, "uniform"},
           {Law::lloyd, "lloyd"},
           {Law::vangelder, "vangelder"}}};
}

constexpr std::array<Word<Volume>, 3> words_of(Volume) {
  return {{{Volume::none, "none"}, {Volume::tet, "tet"}, {Volume::node, "node"}}};
}

constexpr std::array<Word<LloydLength>, 2> words_of(LloydLength) {
  return {{{LloydLength::tet, "tet"}, {LloydLength::edge, "edge"}}};
}

constexpr std::array<Word<Damping>, 3> words_of(Damping) {
  return {{{Damping::ratio, "ratio"},
           {Damping::published, "published"},
           {Damping::material, "material"}}};
}

}  // namespace sinew
