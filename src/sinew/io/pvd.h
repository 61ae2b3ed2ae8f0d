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
// Complete or absent (file_io.h), so it may be rewritten after every frame.
void write_pvd(const std::filesystem::path& path, std::span<const PvdEntry> entries);

}  // namespace sinew::io
