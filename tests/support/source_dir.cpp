#include "tests/support/source_dir.h"

namespace sinew::test {

std::string source_path(std::string_view name) {
  std::string path(SINEW_SOURCE_DIR);
  path += '/';
  path += name;
  return path;
}

}  // namespace sinew::test
