// The path of the repository. Only one source file knows it, so that no other command line has a
// path of this machine and compiler caches work across folders.
#pragma once

#include <string>
#include <string_view>

namespace sinew::test {

// Absolute, of a file or folder named from the root of the repository: source_path("scenes").
std::string source_path(std::string_view name);

}  // namespace sinew::test
