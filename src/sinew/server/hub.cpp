#include "sinew/server/hub.h"

#include <algorithm>

#include "sinew/base/error.h"

namespace sinew::server {

void Hub::join(Socket* socket) {
  sockets_.push_back(socket);
  if (controller_ == nullptr) {
    give_controls(socket);
  } else {
    tell_roles();
  }
}

void Hub::leave(Socket* socket) {
  if (std::erase(sockets_, socket) == 0 || !runner) return;
  if (controller_ != socket) return tell_roles();
  for (int hand = 0; hand < live::most_hands; ++hand) runner->post(live::Release{hand});
  runner->post(live::RemoveBall{});
  give_controls(sockets_.empty() ? nullptr : sockets_.front());
}

void Hub::give_controls(Socket* socket) {
  controller_ = socket;
  ticket_ = make_token();
  tell_roles();
}

void Hub::tell_roles() {
  for (Socket* s : sockets_) {
    s->viewer().note(role_text(s == controller_, static_cast<int>(sockets_.size()), ticket_));
    s->pump();
  }
}

void Hub::hear(Socket* socket, const std::string& text) {
  const auto post = [&](live::Command command) {
    if (runner->post(std::move(command))) return;
    socket->viewer().note(error_text("the simulation is busy: the command was dropped"));
  };
  Request request = parse_request(text);
  if (const auto* seen = std::get_if<Seen>(&request)) {
    socket->viewer().seen(seen->frame);
  } else if (std::holds_alternative<TakeControls>(request)) {
    give_controls(socket);
  } else if (!controls(socket)) {
    socket->viewer().note(error_text("another browser has the controls"));
  } else if (const auto* open = std::get_if<Open>(&request)) {
    post(live::Open{library.opener(*open)});
  } else {
    post(std::get<live::Command>(std::move(request)));
  }
}

bool Hub::has_ticket(std::string_view target) const {
  return controller_ != nullptr && same_secret(query_value(target, "ticket"), ticket_);
}

void Hub::pump() {
  for (Socket* s : sockets_) s->pump();
}

void Hub::close_all() {
  for (Socket* s : sockets_) s->go_away();
}

}  // namespace sinew::server
