// Reading and writing of whole files. A file that Sinew writes is complete or absent.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sinew::io {

// The bytes of a regular file. Error (input) if it is missing, a folder, a device, or empty; Error
// (io) if the system refuses to read it.
std::string read_file(const std::filesystem::path& path);

// Writes to "NAME.tmp" beside the target, then renames it. A reader, also after a crash of the
// writer, sees the old file or the new one, never a part. Error (io) with the system's reason; the
// temporary file is then removed. Safe against a killed process, not against a power cut.
void write_file(const std::filesystem::path& path, std::string_view bytes);

// Waits until a file, or the list of a folder's files, is on the disk. Error (io).
void sync_to_disk(const std::filesystem::path& path);

// write_file() that also survives a power cut: the file is on the disk before it replaces the old
// one, and the folder's list afterwards. "NAME.new" and "NAME.new.tmp" are its temporary files.
void write_durably(const std::filesystem::path& path, std::string_view bytes);

// The extension of a path in lower case, with its dot: ".mesh". Empty if there is none.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace sinew::io
