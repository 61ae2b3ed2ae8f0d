// What a user's mistake is told.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "sinew/base/error.h"

namespace sinew::test {

// what() of the error that `act` ends with; empty without one.
template <typename Act>
std::string error_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

// The message alone of an error in an input, which names a remedy too; "no error" without one.
template <typename Act>
std::string message_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_FALSE(error.remedy().empty());
    return error.message();
  }
  return "no error";
}

}  // namespace sinew::test
