// The scenes that a server can open: those that come with Sinew, and files from its viewers.
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

  // `scenes`: the folder of Sinew's scenes, with their pictures in "pictures"; may be empty. Scenes
  // that cannot be read are omitted.
  explicit Library(std::filesystem::path scenes);
  ~Library();  // removes the received files
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  // See docs/protocol.md.
  std::string gallery() const;
  // The bytes of "/gallery/NAME.jpg"; nothing if there is no such picture.
  std::optional<std::string> picture(std::string_view path) const;

  // Stores a file for open(), replacing an earlier one of that name. Throws Error(usage) for an
  // invalid name, an unknown extension, or too many bytes; Error(io).
  void keep(const std::string& name, std::string_view bytes);

  // Removes the folder of the received files from a text, so that a message has the viewer's file
  // names.
  void leave_out_folder(std::string& text) const;

  // Returns a function that reads the requested scene. It may be called on any thread during the
  // library's lifetime, and throws the errors of load_scene and scene_around. Throws Error(usage)
  // if there is no such scene or file.
  std::function<Scene()> opener(const Open& open) const;

 private:
  struct Entry {
    std::filesystem::path file;
    std::string name, title, look_for;
    std::filesystem::path picture;  // empty: none
  };

  std::vector<Entry> entries_;
  std::filesystem::path folder_;             // of the received files; empty: none yet
  std::map<std::string, std::size_t> kept_;  // sizes by name
};

}  // namespace sinew::server
