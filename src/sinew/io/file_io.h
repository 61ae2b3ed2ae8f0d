// Whole files in, whole files out. A file that Sinew writes is complete or is not there.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sinew::io {

// The bytes of a regular file. Error (input) where it is missing, a folder, a device, or empty;
// Error (io) where the system will not read it.
std::string read_file(const std::filesystem::path& path);

// Writes to "NAME.tmp" beside the target, then renames: a reader, or a run killed half-way, sees
// the old file or the new one, never a part. Error (io) with the system's reason; the temporary
// file is then removed. Not synced to disk: safe against a killed process, not a power cut.
void write_file(const std::filesystem::path& path, std::string_view bytes);

// The extension of a path in lower case, with its dot: ".mesh". Empty if there is none.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace sinew::io
