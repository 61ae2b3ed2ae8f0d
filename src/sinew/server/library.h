// The scenes that a server can open: those that are shipped, and files that its viewers give it.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sinew/scene/scene.h"
#include "sinew/server/protocol.h"

namespace sinew::server {

class Library {
 public:
  static constexpr std::size_t most_file_bytes = std::size_t{64} << 20;
  static constexpr std::size_t most_bytes = std::size_t{256} << 20;  // of all files

  // `scenes`: the folder of the shipped scenes, with their pictures in "pictures"; may be empty.
  // Scenes in it that cannot be read are left out.
  explicit Library(std::filesystem::path scenes);
  ~Library();  // removes the files that were given
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  // As docs/protocol.md says.
  std::string gallery() const;
  // The bytes of "/gallery/NAME.jpg"; nothing where there is no such picture.
  std::optional<std::string> picture(std::string_view path) const;

  // Keeps a file for open(), in the place of an earlier one of that name. Throws Error(usage) for a
  // name that is none or has no ending that can be opened, or too many bytes; Error(io).
  void keep(const std::string& name, std::string_view bytes);

  // Takes the folder of the files given out of a text: a message names files as their viewer does.
  void leave_out_folder(std::string& text) const;

  // Reads what is asked for when it is called, from any thread while the library is there. The
  // function throws what load_scene and scene_around throw; Error(usage) here where there is no
  // such scene or file.
  std::function<Scene()> opener(const Open& open) const;

 private:
  struct Entry {
    std::filesystem::path file;
    std::string name, title, look_for;
    std::filesystem::path picture;  // empty: none
  };

  std::vector<Entry> entries_;
  std::filesystem::path folder_;             // of the files given; empty: none yet
  std::map<std::string, std::size_t> kept_;  // sizes by name
};

}  // namespace sinew::server
