#include "sinew/io/file_io.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include "sinew/base/error.h"
#include "sinew/base/text.h"

namespace sinew::io {
namespace fs = std::filesystem;
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

std::string reason(int code) {
  return std::generic_category().message(code);
}

[[noreturn]] void fail_read(const fs::path& path, int code) {
  throw Error(ErrorKind::io, "cannot be read: " + reason(code),
              "check the permissions of the file and of its folder", {path.string(), 0, 0});
}

[[noreturn]] void fail_write(const fs::path& path, const std::string& why) {
  throw Error(ErrorKind::io, "cannot be written: " + why,
              "check that the folder exists and is writable, and that the disk has room",
              {path.string(), 0, 0});
}

}  // namespace

std::string read_file(const fs::path& path) {
  const Location where{path.string(), 0, 0};
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (status.type() == fs::file_type::not_found) {
    throw Error(ErrorKind::input, "no such file", "check the name and the folder", where);
  }
  if (code) fail_read(path, code.value());
  if (fs::is_directory(status)) {
    throw Error(ErrorKind::input, "is a folder, a file was expected", "name a file inside it",
                where);
  }
  if (!fs::is_regular_file(status)) {
    throw Error(ErrorKind::input, "is not a regular file (a pipe or a device)",
                "save the data to a file first", where);
  }
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail_read(path, errno);
  std::string bytes(fs::file_size(path, code), '\0');
  if (code) fail_read(path, code.value());
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  if (std::ferror(file.get()) != 0) fail_read(path, errno);
  if (bytes.empty()) {
    throw Error(ErrorKind::input, "is empty", "write or fetch the file again", where);
  }
  return bytes;
}

void write_file(const fs::path& path, std::string_view bytes) {
  if (path.filename().empty() || fs::is_directory(path)) {
    fail_write(path, "it is a folder, a file name was expected");
  }
  fs::path temporary = path;
  temporary += ".tmp";
  File file(std::fopen(temporary.c_str(), "wb"));
  if (!file) fail_write(path, reason(errno));
  int failure = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) failure = errno;
  if (std::fclose(file.release()) != 0 && failure == 0) failure = errno;
  if (failure == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) failure = errno;
  if (failure != 0) {
    std::error_code ignored;
    fs::remove(temporary, ignored);
    fail_write(path, reason(failure));
  }
}

void sync_to_disk(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail_write(path, reason(errno));
  const int code = ::fsync(file) == 0 ? 0 : errno;
  ::close(file);
  // Some file systems do not sync folders.
  if (code != 0 && code != EINVAL && code != EROFS) fail_write(path, reason(code));
}

void write_durably(const fs::path& path, std::string_view bytes) {
  fs::path fresh = path;
  fresh += ".new";
  write_file(fresh, bytes);
  sync_to_disk(fresh);
  std::error_code failed;
  fs::rename(fresh, path, failed);
  if (failed) fail_write(path, failed.message());
  sync_to_disk(path.has_parent_path() ? path.parent_path() : fs::path("."));
}

std::string lower_extension(const fs::path& path) {
  return lower_case(path.extension().string());
}

}  // namespace sinew::io
