#include "sinew/base/spawn.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>

namespace sinew {
namespace {

class NoActions {
 public:
  NoActions() { posix_spawn_file_actions_init(&actions_); }
  ~NoActions() { posix_spawn_file_actions_destroy(&actions_); }
  const posix_spawn_file_actions_t& get() const { return actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

TEST(Spawn, StartsAProgramWithItsArguments) {
  pid_t child = 0;
  ASSERT_EQ(spawn({"sh", "-c", "exit $1", "sh", "7"}, NoActions().get(), child), 0);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

TEST(Spawn, TheProgramHearsSignalsThatThisThreadBlocks) {
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &blocked, &before);
  pid_t child = 0;
  const int failure = spawn({"sleep", "60"}, NoActions().get(), child);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  ASSERT_EQ(failure, 0);
  kill(child, SIGTERM);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status));
}

TEST(Spawn, SaysWhyAProgramCannotBeStarted) {
  pid_t child = 0;
  EXPECT_EQ(spawn({"sinew-no-such-program"}, NoActions().get(), child), ENOENT);
}

}  // namespace
}  // namespace sinew
