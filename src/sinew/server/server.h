// Serves the page and the live simulation behind it: HTTP and WebSocket on one thread.
// docs/protocol.md.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "sinew/live/runner.h"
#include "sinew/server/guard.h"

namespace sinew::server {

struct Options {
  std::string host = "127.0.0.1";  // address to listen at
  unsigned short port = 0;         // 0: any that is free
  std::string token;               // that every request has to name; empty: none
  int most_connections = 64;       // more are closed at once
  std::filesystem::path scenes;    // folder of the gallery; empty: it has none
  bool gallery = false;            // pages begin with the gallery
};

class Server {
 public:
  // Builds the scene, then listens. Throws what live::Runner throws; Error(io) where the address or
  // port cannot be had.
  Server(const Options& options, const Scene& scene);
  ~Server();

  // Serves until stop() is called.
  void run();
  // From any thread.
  void stop();

  unsigned short port() const;
  // Where the page is: "http://127.0.0.1:8650/".
  std::string url() const;
  live::Runner& runner();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew::server
