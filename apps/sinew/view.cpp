// sinew view: the live view in the browser.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <thread>

#include "commands.h"
#include "framework_options.h"
#include "interrupt.h"
#include "own_scenes.h"
#include "sinew/base/error.h"
#include "sinew/base/parallel.h"
#include "sinew/base/spawn.h"
#include "sinew/scene/around.h"
#include "sinew/scene/filled.h"
#include "sinew/server/server.h"

using namespace sinew;

namespace {

constexpr const char* view_footer = R"(
The page needs no internet: it is part of this program. Whoever opens the address first has the
controls, others watch. Ctrl-C ends it.

Without a scene the page begins with the gallery of those that come with Sinew. A mesh alone is shown
as soft tissue that hangs from its top. Scenes and meshes can be dropped on the page, too.

Examples:
  sinew view
  sinew view scenes/liver.toml
  sinew view organ.vtu
  sinew view scenes/liver.toml --set liver.young=20e3 --open
  sinew view two_cylinder-scene.txt --constraints two_cylinder-constraints.txt
  sinew view scenes/beam.toml --host 0.0.0.0     for other machines, with the printed token)";

struct ViewArguments {
  std::string scene;   // empty: the gallery
  std::string scenes;  // its folder; empty: the usual place
  std::vector<std::string> set;
  FrameworkOptions framework;
  std::string host = "127.0.0.1";
  int port = 8650;
  bool open = false, quiet = false;
  int threads = 0;
};

sigset_t end_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  return signals;
}

// Waits for Ctrl-C or SIGTERM on a separate thread. Before there is a server the program ends at
// once; afterwards the server is stopped, and a step that goes on for long is not waited for:
// nothing is to be saved. Signals must be blocked before any other thread starts.
class StopOnSignal {
 public:
  StopOnSignal()
      : thread_([this](const std::stop_token& token) {
          const sigset_t signals = end_signals();
          const timespec a_moment{0, 20'000'000};
          while (!token.stop_requested()) {
            if (sigtimedwait(&signals, nullptr, &a_moment) < 0) continue;
            server::Server* const server = server_.load();
            end_meshers();
            if (server == nullptr) _exit(interrupted);
            server->stop();
            constexpr int moments = 7;  // time to say goodbye to the browsers
            for (int i = 0; i < moments && !token.stop_requested(); ++i)
              nanosleep(&a_moment, nullptr);
            if (!token.stop_requested()) _exit(0);
          }
        }) {}
  void stops(server::Server& server) { server_.store(&server); }

 private:
  std::atomic<server::Server*> server_{nullptr};
  std::jthread thread_;
};

// Asks the desktop to show the page. Without a desktop only the address is printed.
void open_browser(const std::string& url) {
#ifdef __APPLE__
  const std::string program = "open";
#else
  const std::string program = "xdg-open";
#endif
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&quiet, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  std::signal(SIGCHLD, SIG_IGN);  // nobody waits for it
  if (spawn({program, url}, quiet, child) != 0) {
    fmt::print(stderr, "sinew: no {} here: open the address by hand\n", program);
  }
  posix_spawn_file_actions_destroy(&quiet);
}

// The scene behind the gallery until one is chosen.
std::string first_scene(const std::filesystem::path& scenes) {
  const std::filesystem::path file = scenes / "liver.toml";
  std::error_code ignored;
  if (!scenes.empty() && std::filesystem::is_regular_file(file, ignored)) return file.string();
  throw Error(ErrorKind::usage, "there is no gallery here to begin with",
              "name a scene: sinew view scenes/liver.toml, or the folder: --scenes DIR");
}

int view(const ViewArguments& a) {
  const sigset_t signals = end_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  StopOnSignal stop;
  const ThreadLimit limit(a.threads);
  server::Options options;
  options.host = a.host;
  options.port = static_cast<unsigned short>(a.port);
  if (!server::is_loopback(a.host)) options.token = server::make_token();
  options.scenes = a.scenes.empty() ? find_scenes() : std::filesystem::path(a.scenes);
  options.gallery = a.scene.empty();
  const std::string scene = a.scene.empty() ? first_scene(options.scenes) : a.scene;
  point_to_own_scene("view", scene);
  const Scene loaded = load_scene_or_mesh(scene, a.set, a.framework);
  for (const std::string& warning : loaded.warnings) fmt::print(stderr, "warning: {}\n", warning);
  server::Server server(options, loaded);
  stop.stops(server);
  fmt::print("{}\n", server.url());
  if (!a.quiet) fmt::print("Open it in a browser. Ctrl-C ends.\n");
  std::fflush(stdout);
  if (a.open) open_browser(server.url());
  server.run();
  return 0;
}

}  // namespace

void add_view(CLI::App& app, int& status) {
  auto a = std::make_shared<ViewArguments>();
  CLI::App* command =
      app.add_subcommand("view", "Show a scene live in the browser: watch it, pull it, change it");
  command->add_option("SCENE", a->scene,
                      "Scene file (TOML, or of the course framework) or mesh; none: the gallery");
  command->add_option("--scenes", a->scenes, "Folder of the gallery's scenes")
      ->type_name("DIR")
      ->default_str("those that come with Sinew");
  command->add_option("--port", a->port, "Port to serve the page at; 0 for any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command->add_flag("--open", a->open, "Open the page in the desktop's browser");
  command
      ->add_option("--host", a->host,
                   "Address to serve at; other than this machine's own needs the printed token")
      ->capture_default_str();
  command->add_option("--set", a->set, "Override a value: --set beam.young=1.5e6")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command->add_flag("-q,--quiet", a->quiet, "Print the address and errors only");
  command->add_option("--threads", a->threads, "Threads to use; the result does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->default_str("all");
  add_framework_options(*command, a->framework);
  command->footer(view_footer);
  command->callback([a, &status] { status = view(*a); });
}
