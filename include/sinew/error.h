// The one type of error. The library throws it, never prints and never exits.
#pragma once

#include <sinew/export.h>

#include <stdexcept>
#include <string>

namespace sinew {

// The kind of an error, which decides the caller's reaction. The value is the command line's exit
// code.
enum class ErrorKind {
  internal = 1,  // a fault of Sinew itself
  usage = 2,     // a wrong command line or call
  input = 3,     // a file or a value that cannot be used
  unstable = 4,  // the step is longer than the stable one; nothing was run
  diverged = 5,  // the state became infinite during a run
  io = 6,        // the system refused to read or write
};

// The place of a fault in a file. line and column count from 1; 0 means unknown. For a scene that
// is built in code, `file` is "SceneBuilder"; for a wrong call it is empty.
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
};

// `what()` is "file:line:column: message\n  remedy: ..." without the unknown parts.
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
