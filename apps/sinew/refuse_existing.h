// The files that writing a mesh would replace.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/base/error.h"
#include "sinew/io/file_io.h"

namespace sinew {

// Error (usage) if the file, or one of the files of a TetGen set, exists.
inline void refuse_existing(const std::filesystem::path& out) {
  const std::string ending = io::lower_extension(out);
  std::vector<std::filesystem::path> files = {out};
  if (ending == ".node" || ending == ".ele") {
    files.clear();
    for (const char* part : {".node", ".ele", ".face"}) {
      files.push_back(std::filesystem::path(out).replace_extension(part));
    }
  }
  for (const std::filesystem::path& file : files) {
    if (!std::filesystem::exists(file)) continue;
    throw Error(ErrorKind::usage, "the file exists already", "add --force to replace it",
                {file.string()});
  }
}

}  // namespace sinew
