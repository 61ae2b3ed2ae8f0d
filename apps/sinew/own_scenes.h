// The scenes that come with Sinew.
#pragma once

#include <filesystem>
#include <string>

// Their folder: below the working directory, in the source tree of the build, or installed beside
// the program. Empty: there is none.
std::filesystem::path find_scenes();

// Throws Error(io) if there is no such file, but Sinew has a scene of that name: the remedy says
// where. `command` is the one that was called.
void point_to_own_scene(const std::string& command, const std::string& file);
