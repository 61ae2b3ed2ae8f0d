// Messages of errors in tests.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "sinew/base/error.h"

namespace sinew::test {

// what() of the error that `act` throws; empty without one.
template <typename Act>
std::string error_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

// The message of an input error, which also names a remedy; "no error" without one.
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
