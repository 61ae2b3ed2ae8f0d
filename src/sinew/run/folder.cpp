#include "sinew/run/folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/base/hash.h"
#include "sinew/io/file_io.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = "run.lock";
constexpr std::string_view first_line = "Sinew run folder: locked while a run is writing here\n";

[[noreturn]] void fail(const fs::path& path, const std::string& what, int code) {
  throw Error(ErrorKind::io, fmt::format("{}: {}", what, std::generic_category().message(code)),
              "choose an --out where you may write, with a shorter path and without loops of links",
              Location{path.string()});
}

std::string hash_of(std::string_view text) {
  Hash hash;
  hash.text(text);
  return hex(hash.digest());
}

// The content of run.lock.
struct List {
  std::string process;
  std::string scene_hash;  // of scene.toml as Sinew wrote it; empty: not known
  RunFiles files;
};

// The bytes of a small file; none if it is not there.
std::optional<std::string> bytes_of(const fs::path& file) {
  std::error_code failed;
  const auto size = fs::file_size(file, failed);
  if (failed) return std::nullopt;
  return size == 0 ? std::string() : io::read_file(file);
}

// None for a file that Sinew did not write.
std::optional<List> parse_list(const std::string& text) {
  List list;
  if (text.empty()) return list;  // its writer ended at once
  if (!std::string_view(text).starts_with(first_line)) return std::nullopt;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t space = std::min(line.find(' '), line.size());
    const std::string key = line.substr(0, space);
    const std::string value = line.substr(std::min(space + 1, line.size()));
    if (key == "process") list.process = value;
    if (key == "scene.toml") list.scene_hash = value;
    if (key == "frames") list.files.scene = value;
    if (key == "file") list.files.names.push_back(value);
  }
  return list;
}

// What Sinew wrote into a folder, by its run.lock; none if the folder holds no run.
std::optional<List> list_of(const fs::path& folder) {
  const auto text = bytes_of(folder / lock_name);
  return text ? parse_list(*text) : std::nullopt;
}

bool is_frame_of(const std::string& name, const std::string& scene) {
  const std::string_view start = name;
  if (!start.starts_with(scene + "_")) return false;
  std::string_view rest = start.substr(scene.size() + 1);
  const std::size_t digits = std::min(rest.find_first_not_of("0123456789"), rest.size());
  rest.remove_prefix(digits);
  return digits >= 4 && (rest == ".vtu" || rest == ".vtu.tmp");
}

// The entries of a folder by name; none if it is not there. Error(io) if the system refuses.
std::vector<std::string> entries_of(const fs::path& folder) {
  std::error_code failed;
  const fs::file_status status = fs::status(folder, failed);
  if (status.type() == fs::file_type::not_found) return {};
  if (failed) fail(folder, "the folder cannot be used", failed.value());
  if (!fs::is_directory(status)) fail(folder, "this is no folder", ENOTDIR);
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed))
    names.push_back(entry->path().filename().string());
  if (failed) fail(folder, "the folder cannot be read", failed.value());
  std::sort(names.begin(), names.end());
  return names;
}

// The files of a run that are in the folder, as paths.
std::vector<fs::path> present(const fs::path& folder, const RunFiles& files) {
  std::vector<fs::path> out;
  std::error_code ignored;
  for (const std::string& name : files.names) {
    for (const std::string& at : {name, name + ".tmp", name + ".new", name + ".new.tmp"}) {
      if (fs::symlink_status(folder / at, ignored).type() != fs::file_type::not_found)
        out.push_back(folder / at);
    }
  }
  if (files.scene.empty()) return out;
  for (const std::string& name : entries_of(folder / "frames"))
    if (is_frame_of(name, files.scene)) out.push_back(folder / "frames" / name);
  return out;
}

void refuse_held(const fs::path& folder, bool force) {
  if (force) return;
  const std::vector<std::string> entries = entries_of(folder);
  if (entries.empty()) return;
  if (list_of(folder))
    throw Error(ErrorKind::usage, "the folder already holds a run",
                "choose another --out, or --force to replace it, or 'sinew resume' to go on",
                Location{folder.string()});
  const std::size_t shown = std::min<std::size_t>(entries.size(), 3);
  throw Error(
      ErrorKind::usage,
      fmt::format(
          "the folder holds files that Sinew did not write: {}{}",
          fmt::join(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
          entries.size() > shown ? ", ..." : ""),
      "choose another --out, such as a new folder; --force writes beside them and replaces none",
      Location{folder.string()});
}

// A file that the run would replace or remove although it is not Sinew's.
[[noreturn]] void refuse_in_the_way(const fs::path& file, const std::string& why) {
  throw Error(ErrorKind::usage, why, "choose another --out, or move the file away",
              Location{file.string()});
}

}  // namespace

void RunFolder::require_free(const fs::path& folder, bool force) {
  refuse_held(folder, force);
}

RunFolder RunFolder::make(const fs::path& folder, bool force, const RunFiles& files,
                          const std::vector<fs::path>& inputs, std::string_view scene_toml) {
  refuse_held(folder, force);
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) fail(folder, "cannot make the folder", failed.value());
  RunFolder out(folder);
  refuse_held(folder, force || entries_of(folder) == std::vector<std::string>{lock_name});
  const List old = list_of(folder).value_or(List{});
  const std::vector<fs::path> ours = present(folder, old.files);
  for (const fs::path& file : present(folder, files)) {
    if (std::find(ours.begin(), ours.end(), file) == ours.end())
      refuse_in_the_way(file, "Sinew did not write this file, and the run would replace it");
  }
  for (const fs::path& file : ours) {
    for (const fs::path& input : inputs) {
      if (fs::equivalent(file, input, failed) && !failed)
        refuse_in_the_way(file, "the run reads this file, and would replace it");
    }
  }
  const auto scene_before = bytes_of(folder / "scene.toml");
  if (scene_before && !old.scene_hash.empty() && hash_of(*scene_before) != old.scene_hash)
    refuse_in_the_way(folder / "scene.toml",
                      "the file was edited after Sinew wrote it, and the run would replace it");
  for (const fs::path& file : ours) {
    if (!fs::remove(file, failed) && failed) fail(file, "cannot be removed", failed.value());
  }
  fs::create_directories(folder / "frames", failed);
  if (failed) fail(folder / "frames", "cannot make the folder", failed.value());
  out.write_list(files, hash_of(scene_toml));
  io::write_durably(folder / "scene.toml", scene_toml);
  return out;
}

RunFolder RunFolder::open(const fs::path& folder) {
  RunFolder out(folder);
  const List list = list_of(folder).value_or(List{});
  out.write_list(list.files, list.scene_hash);
  return out;
}

// Takes the lock.
RunFolder::RunFolder(const fs::path& folder) : folder_(folder) {
  const fs::path file = folder / lock_name;
  lock_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock_ < 0) fail(file, "cannot be written", errno);
  const std::string text = bytes_of(file).value_or("");
  const std::optional<List> list = parse_list(text);
  if (!list) {
    ::close(lock_);
    refuse_in_the_way(file, "Sinew did not write this file, and the run would replace it");
  }
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
  const int code = errno;
  ::close(lock_);
  if (code != EWOULDBLOCK) fail(file, "cannot be locked", code);
  throw Error(ErrorKind::usage,
              list->process.empty()
                  ? "another run is writing here"
                  : fmt::format("another run is writing here (process {})", list->process),
              "wait for its end or stop it, or choose another --out", Location{folder.string()});
}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : folder_(std::move(other.folder_)), lock_(std::exchange(other.lock_, -1)) {}

RunFolder::~RunFolder() {
  if (lock_ >= 0) ::close(lock_);
}

// In place, because the lock belongs to this file.
void RunFolder::write_list(const RunFiles& files, const std::string& scene_hash) const {
  std::string text(first_line);
  text +=
      fmt::format("process {}\nscene.toml {}\nframes {}\n", ::getpid(), scene_hash, files.scene);
  for (const std::string& name : files.names) text += fmt::format("file {}\n", name);
  const bool written =
      ::ftruncate(lock_, 0) == 0 &&
      ::pwrite(lock_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()) &&
      ::fsync(lock_) == 0;
  if (!written) fail(folder_ / lock_name, "cannot be written", errno);
}

}  // namespace sinew
