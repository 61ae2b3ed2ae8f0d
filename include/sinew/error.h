// The one type of error. The library throws it, never prints and never exits.
#pragma once

#include <sinew/export.h>

#include <stdexcept>
#include <string>

namespace sinew {

// What went wrong, in the terms a caller can act on. The value is the command line's exit code.
enum class ErrorKind {
  internal = 1,  // a bug of ours
  usage = 2,     // a wrong command line or call
  input = 3,     // a file or a value that cannot be used as it is
  unstable = 4,  // the step is larger than the stable one; nothing has been run
  diverged = 5,  // the state turned non-finite during a run
  io = 6,        // the system refused to read or write
};

// Where in a file the mistake stands. line and column count from 1; 0 means unknown. For a scene
// that is built in code, `file` is "SceneBuilder"; for a wrong call it is empty.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
};

// `what()` is "file:line:column: message\n  remedy: ..." with the unknown parts left out.
class SINEW_API Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, std::string message, std::string remedy = {}, Location location = {});

  ErrorKind kind() const { return kind_; }
  const std::string& message() const { return message_; }
  const std::string& remedy() const { return remedy_; }
  const Location& location() const { return location_; }

 private:
  ErrorKind kind_;
  std::string message_;
  std::string remedy_;
  Location location_;
};

}  // namespace sinew
