// tests/data/meshes/malformed: every file there has its exact message in expected.txt, which is
// "== NAME", then what Error::what() says with paths reduced to file names.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "sinew/base/error.h"
#include "sinew/io/mesh_io.h"
#include "tests/io/two_tets.h"

namespace sinew::io {
namespace {
namespace fs = std::filesystem;

std::map<std::string, std::string> expected_messages() {
  std::ifstream file(mesh_data("malformed/expected.txt"));
  std::map<std::string, std::string> messages;
  std::string* message = nullptr;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("== ")) {
      message = &messages[line.substr(3)];
    } else if (message != nullptr) {
      *message += (message->empty() ? "" : "\n") + line;
    }
  }
  return messages;
}

std::string message_of(const std::string& name) {
  const std::string folder = mesh_data("malformed/");
  std::string message = "no error";
  try {
    read_mesh(folder + name);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_FALSE(error.remedy().empty());
    message = error.what();
  }
  for (std::size_t at = 0; (at = message.find(folder)) != message.npos;) {
    message.erase(at, folder.size());
  }
  return message;
}

TEST(Malformed, EveryFileHasItsExactMessage) {
  const auto messages = expected_messages();
  EXPECT_GE(messages.size(), 90U);
  for (const auto& [name, message] : messages) {
    EXPECT_EQ(message_of(name), message) << name;
  }
}

TEST(Malformed, EveryFileIsInTheTable) {
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(mesh_data("malformed"))) {
    // A TetGen pair is listed by its .node file.
    fs::path name = entry.path().filename();
    if (name.extension() == ".ele") name.replace_extension(".node");
    if (name != "expected.txt") files.insert(name.string());
  }
  std::set<std::string> listed;
  for (const auto& [name, message] : expected_messages()) listed.insert(name);
  EXPECT_EQ(files, listed);
}

}  // namespace
}  // namespace sinew::io
