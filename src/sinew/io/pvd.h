// A ParaView collection (.pvd): the files of a time series with their times.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace sinew::io {

struct PvdEntry {
  double time = 0;   // [s]
  std::string file;  // relative to the folder of the .pvd
};

std::string format_pvd(std::span<const PvdEntry> entries);
// As a whole or not at all (file_io.h), so that it may be written anew after every frame.
void write_pvd(const std::filesystem::path& path, std::span<const PvdEntry> entries);

}  // namespace sinew::io
