// State shared by all connections of a server: the viewers, and the viewer with the controls.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sinew/live/runner.h"
#include "sinew/server/guard.h"
#include "sinew/server/library.h"
#include "sinew/server/protocol.h"
#include "sinew/server/viewer.h"

namespace sinew::server {

// A browser at the other end of a WebSocket.
class Socket {
 public:
  Socket() = default;
  virtual ~Socket() = default;
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  virtual Viewer& viewer() = 0;
  virtual void pump() = 0;  // sends the next message, unless one is still being sent
  virtual void go_away() = 0;
};

// Used on the thread of Server::run() only, except for the count of connections.
class Hub {
 public:
  Hub(Door its_door, const std::filesystem::path& scenes, bool begin_with_gallery)
      : door(std::move(its_door)), library(scenes), gallery(begin_with_gallery) {}

  void join(Socket* socket);
  void leave(Socket* socket);
  // Handles a message of a viewer. Throws Error(usage) if it is not permitted or not valid.
  void hear(Socket* socket, const std::string& text);
  bool controls(const Socket* socket) const { return socket == controller_; }
  // Whether a target's query holds the ticket of the viewer that has the controls.
  bool has_ticket(std::string_view target) const;
  void pump();
  void close_all();

  Door door;
  Library library;
  bool gallery;         // whether pages start with it
  bool framed = false;  // whether a page of this machine may show ours in a frame
  std::atomic<int> connections{0};
  int uploads = 0;                       // of files, in progress
  std::unique_ptr<live::Runner> runner;  // null: the server is shutting down

 private:
  void give_controls(Socket* socket);
  void tell_roles();

  std::vector<Socket*> sockets_;
  Socket* controller_ = nullptr;
  std::string ticket_;
};

// Counts a connection during its lifetime.
class Place {
 public:
  explicit Place(Hub& hub) : hub_(&hub) { ++hub.connections; }
  Place(Place&& other) noexcept : hub_(std::exchange(other.hub_, nullptr)) {}
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  Place& operator=(Place&&) = delete;
  ~Place() {
    if (hub_ != nullptr) --hub_->connections;
  }

 private:
  Hub* hub_;
};

}  // namespace sinew::server
