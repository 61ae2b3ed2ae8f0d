#include "sinew/server/library.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "sinew/base/error.h"
#include "sinew/io/file_io.h"
#include "sinew/io/mesh_io.h"
#include "sinew/scene/around.h"

namespace sinew::server {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view pictures = "/gallery/";

bool can_be_kept(const std::string& name) {
  const std::string end = io::lower_extension(name);
  return end == ".toml" || end == ".face" || io::is_mesh_name(name);
}

bool is_plain(const std::string& name) {
  return !name.empty() && name.size() <= 100 && name.front() != '.' &&
         name.find_first_not_of(
             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-") ==
             std::string::npos;
}

// A folder that only this user can read.
fs::path make_folder() {
  // mkdtemp() replaces six of these characters.
  std::string path = (fs::temp_directory_path() / "sinew-view-").string() + std::string(6, 'X');
  if (::mkdtemp(path.data()) == nullptr) {
    throw Error(ErrorKind::io, "cannot make a folder for files", "set TMPDIR to one that is yours",
                Location{path});
  }
  return path;
}

}  // namespace

Library::Library(fs::path scenes) {
  std::error_code ignored;
  for (const auto& file : fs::directory_iterator(scenes, ignored)) {
    if (file.path().extension() != ".toml") continue;
    Entry entry;
    entry.file = file.path();
    entry.name = file.path().stem().string();
    try {
      const Scene scene = load_scene(file.path());
      entry.title = scene.title.empty() ? scene.name : scene.title;
      entry.look_for = scene.look_for;
    } catch (const Error&) {
      continue;
    }
    const fs::path picture = scenes / "pictures" / (entry.name + ".jpg");
    if (is_plain(entry.name) && fs::is_regular_file(picture, ignored)) entry.picture = picture;
    entries_.push_back(std::move(entry));
  }
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return a.name < b.name; });
}

Library::~Library() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

std::string Library::gallery() const {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Entry& e : entries_) {
    nlohmann::ordered_json picture = nullptr;
    if (!e.picture.empty()) picture = fmt::format("{}{}.jpg", pictures, e.name);
    list.push_back({{"name", e.name},
                    {"title", e.title},
                    {"look_for", e.look_for},
                    {"picture", std::move(picture)}});
  }
  return list.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::optional<std::string> Library::picture(std::string_view path) const {
  for (const Entry& e : entries_) {
    if (e.picture.empty() || path != fmt::format("{}{}.jpg", pictures, e.name)) continue;
    return io::read_file(e.picture);
  }
  return std::nullopt;
}

void Library::keep(const std::string& name, std::string_view bytes) {
  if (!is_plain(name)) {
    throw Error(ErrorKind::usage, "the file's name cannot be used",
                "letters, digits, '.', '_' and '-', at most 100, no '.' at the front");
  }
  if (!can_be_kept(name)) {
    throw Error(ErrorKind::usage, fmt::format("'{}' is neither a scene nor a mesh", name),
                fmt::format("a scene ends with .toml, a mesh with {}",
                            fmt::join(io::mesh_endings(), ", ")));
  }
  std::size_t sum = bytes.size();
  for (const auto& [other, size] : kept_) sum += other == name ? 0 : size;
  if (bytes.size() > most_file_bytes || sum > most_bytes) {
    throw Error(ErrorKind::usage, "the files are too large",
                "at most 64 MiB each and 256 MiB together; or name the file on the command line");
  }
  if (folder_.empty()) folder_ = make_folder();
  io::write_file(folder_ / name, bytes);
  kept_[name] = bytes.size();
}

void Library::leave_out_folder(std::string& text) const {
  if (folder_.empty()) return;
  const std::string folder = folder_.string() + "/";
  for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder, at)) {
    text.erase(at, folder.size());
  }
}

std::function<Scene()> Library::opener(const Open& open) const {
  if (open.file.empty()) {
    for (const Entry& e : entries_) {
      if (e.name == open.scene) return [file = e.file] { return load_scene(file); };
    }
    throw Error(ErrorKind::usage, "there is no such scene in the gallery",
                "/gallery.json lists them");
  }
  if (!kept_.contains(open.file)) {
    throw Error(ErrorKind::usage, "no such file was given", "POST it to /files first");
  }
  return [file = folder_ / open.file] { return load_scene_or_mesh(file); };
}

}  // namespace sinew::server
