// Serves the page and the live simulation behind it: HTTP and WebSocket on one thread.
// docs/protocol.md.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "sinew/live/runner.h"
#include "sinew/server/guard.h"

namespace sinew::server {

struct Options {
  std::string host = "127.0.0.1";  // listening address
  unsigned short port = 0;         // 0: any free port
  std::string token;               // required in every request; empty: none
  int most_connections = 64;       // further ones are closed at once
  std::filesystem::path scenes;    // folder of the gallery; empty: it has none
  bool gallery = false;            // pages start with the gallery
  bool framed = false;  // pages of this machine, such as a notebook, may show it in a frame
  std::optional<SavedState> state;  // of the scene, to go on from
};

class Server {
 public:
  // Builds the scene, then listens. Throws the errors of live::Runner; Error(io) if the address or
  // port is not available.
  Server(const Options& options, const Scene& scene);
  ~Server();

  // Serves until stop() is called.
  void run();
  // May be called on any thread.
  void stop();

  unsigned short port() const;
  // The address of the page: "http://127.0.0.1:8650/".
  std::string url() const;
  live::Runner& runner();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew::server
