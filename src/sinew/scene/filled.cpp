#include "sinew/scene/filled.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "sinew/base/cancel.h"
#include "sinew/base/hash.h"
#include "sinew/base/spawn.h"
#include "sinew/io/file_io.h"
#include "sinew/io/image.h"
#include "sinew/io/mesh_io.h"
#include "sinew/io/surface_file.h"

namespace sinew {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t longest_message = 4096;
// Part of the hash. Increase it when sinew-mesh makes different meshes from the same file.
constexpr int mesher_version = 1;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string() : std::string(value);
}

fs::path cache_folder() {
  if (const std::string xdg = environment("XDG_CACHE_HOME"); !xdg.empty()) {
    return fs::path(xdg) / "sinew" / "meshes";
  }
  if (const std::string home = environment("HOME"); !home.empty()) {
    return fs::path(home) / ".cache" / "sinew" / "meshes";
  }
  return fs::temp_directory_path() / "sinew-meshes";
}

std::string mesher() {
  if (std::string named = environment("SINEW_MESH"); !named.empty()) return named;
  std::error_code failed;
  const fs::path beside = fs::read_symlink("/proc/self/exe", failed).parent_path() / "sinew-mesh";
  if (!failed && fs::exists(beside, failed)) return beside.string();
  return "sinew-mesh";
}

// The programs that run(), in any thread, waits for; 0: a free place.
std::array<std::atomic<pid_t>, 16> children{};
std::atomic<int> starting{0};  // threads with a child that is not listed yet
static_assert(std::atomic<pid_t>::is_always_lock_free);  // a signal handler reads them

// Lists a child while its id is its own: not beyond the wait for its end.
class Listed {
 public:
  explicit Listed(pid_t child) {
    for (std::atomic<pid_t>& place : children) {
      pid_t free = 0;
      if (!place.compare_exchange_strong(free, child)) continue;
      place_ = &place;
      return;
    }
  }
  Listed(const Listed&) = delete;
  Listed& operator=(const Listed&) = delete;
  ~Listed() {
    if (place_ != nullptr) place_->store(0);
  }

 private:
  std::atomic<pid_t>* place_ = nullptr;
};

// Between the start of a child and its place in the list. The handler of a signal that ends the
// program waits for it, so this thread must not run that handler: its signals are blocked.
class Starting {
 public:
  Starting() {
    sigset_t ends;
    sigemptyset(&ends);
    sigaddset(&ends, SIGINT);
    sigaddset(&ends, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &ends, &before_);
    ++starting;
  }
  Starting(const Starting&) = delete;
  Starting& operator=(const Starting&) = delete;
  ~Starting() {
    --starting;
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t before_{};
};

// Runs a program and waits. Returns its exit code, or a negative errno if it could not be started;
// `told` receives its standard error.
int run(const std::vector<std::string>& command, std::string& told) {
  std::array<int, 2> pipe_ends{};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) return -errno;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], STDERR_FILENO);
  pid_t child = 0;
  int failure = 0;
  std::optional<Listed> listed;
  {
    const Starting start;
    failure = spawn(command, actions, child);
    if (failure == 0) listed.emplace(child);
  }
  posix_spawn_file_actions_destroy(&actions);
  close(pipe_ends[1]);
  if (failure == 0) {
    std::array<char, 512> buffer{};
    ssize_t got = 0;
    bool ended = false;  // by us
    while (true) {
      pollfd end_of_pipe = {pipe_ends[0], POLLIN, 0};
      constexpr int between_looks = 50;  // [ms]
      const int ready = poll(&end_of_pipe, 1, between_looks);
      if (is_cancelled() && !std::exchange(ended, true)) kill(child, SIGTERM);
      if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
      got = read(pipe_ends[0], buffer.data(), buffer.size());
      if (got == 0 || (got < 0 && errno != EINTR)) break;
      if (got > 0 && told.size() < longest_message) {
        told.append(buffer.data(), static_cast<std::size_t>(got));
      }
    }
  }
  close(pipe_ends[0]);
  if (failure != 0) return -failure;
  listed.reset();
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  stop_if_cancelled();
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// The message of sinew-mesh without its name, in two parts: the fault and the remedy.
std::pair<std::string, std::string> split_message(std::string told) {
  constexpr std::string_view prefix = "sinew-mesh: ";
  constexpr std::string_view remedy = "\n  remedy: ";
  if (told.starts_with(prefix)) told.erase(0, prefix.size());
  while (!told.empty() && told.back() == '\n') told.pop_back();
  const std::size_t at = told.find(remedy);
  if (at == told.npos) return {told, "run sinew-mesh on the file to see more"};
  return {told.substr(0, at), told.substr(at + remedy.size())};
}

// `called`: how messages name the file.
void fill(const fs::path& path, const std::string& called, const fs::path& out, double size,
          const Location& where) {
  // Absolute: a name that begins with '-' is no option.
  std::error_code failed;
  const std::string name = fs::absolute(path, failed).string();
  std::vector<std::string> command = {mesher(),  name, "-q",
                                      "--force", "-o", fs::absolute(out, failed).string()};
  if (size > 0) {
    command.insert(command.end(), {"--size", fmt::format("{}", size)});
  }
  std::string told;
  const int code = run(command, told);
  if (code == 0) return;
  if (code < 0 || code == 127) {
    throw Error(
        ErrorKind::input,
        fmt::format("{} has to be filled with tetrahedra first, and the program for it, {}, "
                    "cannot be started: {}",
                    called, command[0], std::generic_category().message(code < 0 ? -code : ENOENT)),
        "./dev mesh builds it (docs/mesher.md); put it beside sinew or on PATH, or name it in "
        "SINEW_MESH",
        where);
  }
  for (std::size_t at = told.find(name); name != called && at != told.npos;
       at = told.find(name, at + called.size())) {
    told.replace(at, name.size(), called);
  }
  const auto [message, remedy] = split_message(std::move(told));
  throw Error(
      ErrorKind::input,
      message.empty() ? fmt::format("{}: sinew-mesh ended with code {}", called, code) : message,
      remedy, where);
}

// The surface stretched to `fit`, as OFF with all digits.
std::string stretched_off(const fs::path& path, const Vec3& fit, const Location& where) {
  io::SurfaceSoup soup = io::read_surface(path);
  fit_to(soup.nodes, fit, where);
  std::string out = fmt::format("OFF\n{} {} 0\n", soup.nodes.size(), soup.triangles.size());
  for (const Vec3& x : soup.nodes)
    fmt::format_to(std::back_inserter(out), "{} {} {}\n", x.x(), x.y(), x.z());
  for (const Triangle& t : soup.triangles)
    fmt::format_to(std::back_inserter(out), "3 {} {} {}\n", t[0], t[1], t[2]);
  return out;
}

// A file that is removed at the end of the block.
struct Removed {
  fs::path path;
  ~Removed() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

}  // namespace

void end_meshers() noexcept {
  constexpr timespec wait = {0, 1'000'000};
  for (int n = 0; n < 1000 && starting.load() > 0; ++n) nanosleep(&wait, nullptr);
  for (const std::atomic<pid_t>& child : children)
    if (const pid_t id = child.load(); id > 0) kill(id, SIGTERM);
}

bool is_filled(const fs::path& path) {
  return io::is_image_name(path) || io::is_surface_name(path);
}

void fit_to(std::vector<Vec3>& points, const Vec3& sides, const Location& where) {
  if (points.empty()) return;
  Vec3 low = points.front();
  Vec3 high = low;
  for (const Vec3& x : points) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const Vec3 width = high - low;
  if (!(width.minCoeff() > 0.0) || !width.allFinite())
    throw Error(ErrorKind::input,
                fmt::format("a mesh of {:.4g} x {:.4g} x {:.4g} cannot be stretched to a box",
                            width.x(), width.y(), width.z()),
                "it has to reach along every axis: leave fit out", where);
  for (Vec3& x : points) x = sides.cwiseProduct((x - low).cwiseQuotient(width));
}

std::vector<Vec3> surface_vertices(const fs::path& path, const std::optional<Vec3>& fit,
                                   const Location& where) {
  std::vector<Vec3> vertices = io::read_surface(path).nodes;
  if (fit) fit_to(vertices, *fit, where);
  return vertices;
}

TetMesh read_filled(const fs::path& path, double size, const Location& where,
                    const std::optional<Vec3>& fit) {
  Hash hash;
  hash.value(mesher_version);
  hash.text(path.extension().string());  // the format depends on it
  hash.value(size);
  hash.text(io::read_file(path));
  const bool stretched = fit && io::is_surface_name(path);
  if (stretched)
    for (const double side : *fit) hash.value(side);
  const fs::path folder = cache_folder();
  const fs::path kept = folder / (hex(hash.digest()) + ".vtu");
  std::error_code failed;
  if (!fs::exists(kept, failed)) {
    fs::create_directories(folder, failed);
    if (failed) {
      throw Error(ErrorKind::io,
                  fmt::format("cannot make the folder {} for filled meshes: {}", folder.string(),
                              failed.message()),
                  "name another in XDG_CACHE_HOME", where);
    }
    // First under a unique name: two runs may fill the same file at once.
    const fs::path fresh = folder / fmt::format("{}.{}.vtu", hex(hash.digest()), getpid());
    if (stretched) {
      const fs::path surface = folder / fmt::format("{}.{}.off", hex(hash.digest()), getpid());
      io::write_file(surface, stretched_off(path, *fit, where));
      const Removed removed{surface};
      fill(surface, path.string(), fresh, size, where);
    } else {
      fill(path, path.string(), fresh, size, where);
    }
    fs::rename(fresh, kept);
  }
  TetMesh mesh = io::read_mesh(kept);
  if (fit && !stretched) fit_to(mesh.nodes, *fit, where);
  return mesh;
}

}  // namespace sinew
