#include "interrupt.h"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <utility>

#include "sinew/scene/filled.h"

namespace {

std::atomic<bool> stop_requested{false};

extern "C" void request_stop(int signal_number) {
  stop_requested.store(true);
  std::signal(signal_number, SIG_DFL);
}

extern "C" void end_now(int) {
  sinew::end_meshers();
  _exit(interrupted);
}

}  // namespace

void end_on_signals() {
  std::signal(SIGINT, end_now);
  std::signal(SIGTERM, end_now);
}

const std::atomic<bool>& stop_on_signals() {
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  return stop_requested;
}

const std::atomic<bool>& stop_flag() {
  return stop_requested;
}

Impatience::Impatience(const std::atomic<bool>& busy, std::function<void()> say)
    : thread_([&busy, say = std::move(say)](const std::stop_token& token) {
        using namespace std::chrono_literals;
        constexpr auto patience = 120ms, look = 20ms;
        auto waited = 0ms;
        while (!token.stop_requested()) {
          std::this_thread::sleep_for(look);
          if (!stop_requested.load()) continue;
          waited = busy.load() ? waited + look : 0ms;
          if (waited < patience) continue;
          say();
          _exit(interrupted);
        }
      }) {}
