#include "sinew/base/error.h"

#include <utility>

namespace sinew {
namespace {

std::string compose(const std::string& message, const std::string& remedy, const Location& at) {
  std::string text;
  if (!at.file.empty()) {
    text += at.file;
    // Appended, not joined with +: g++ 12 warns of an overlap that does not exist (its bug 105651).
    if (at.line > 0) text.append(":").append(std::to_string(at.line));
    if (at.line > 0 && at.column > 0) text.append(":").append(std::to_string(at.column));
    text += ": ";
  }
  text += message;
  if (!remedy.empty()) text += "\n  remedy: " + remedy;
  return text;
}

}  // namespace

Error::Error(ErrorKind kind, std::string message, std::string remedy, Location location)
    : std::runtime_error(compose(message, remedy, location)),
      kind_(kind),
      message_(std::move(message)),
      remedy_(std::move(remedy)),
      location_(std::move(location)) {}

}  // namespace sinew
