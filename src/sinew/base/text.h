// Words: case, the characters of names, and help for words that a user mistyped.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sinew {

// The text with the letters A to Z in lower case. Other bytes, UTF-8 among them, do not change.
std::string lower_case(std::string_view text);

// Whether names in a scene may contain the character: a letter of ASCII, a digit, '_' or '-'.
bool is_name_character(char c);

// The known word that the user probably meant: the one with the fewest edits (insert, delete,
// replace or swap neighbouring letters; case is ignored), the earlier of two equals. At most one
// edit for every three letters. Otherwise a known word of which `word` is a longer or shorter form
// ("youngs_modulus" for "young"). Empty if there is none.
std::string nearest(std::string_view word, std::span<const std::string_view> known);

}  // namespace sinew
