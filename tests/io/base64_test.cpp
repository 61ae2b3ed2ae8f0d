#include "sinew/io/base64.h"

#include <gtest/gtest.h>

#include <rapidcheck.h>

namespace sinew::io {
namespace {

TEST(Base64, TestVectorsOfRfc4648) {
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) {
    EXPECT_EQ(encode_base64(bytes), text);
    Base64Reader reader(text);
    std::string decoded;
    EXPECT_TRUE(reader.read(std::string_view(bytes).size(), decoded));
    EXPECT_EQ(decoded, bytes);
    EXPECT_FALSE(reader.read(1, decoded));
    EXPECT_FALSE(reader.bad_at());
  }
}

TEST(Base64, PiecesWithTheirOwnPaddingAndBlanks) {
  Base64Reader reader("Zg==\n Zm 9v\nYg==");
  std::string bytes;
  EXPECT_TRUE(reader.read(2, bytes));
  EXPECT_TRUE(reader.read(3, bytes));
  EXPECT_EQ(bytes, "ffoob");
}

TEST(Base64, NamesTheCharacterThatIsNotBase64) {
  for (const auto& [text, place] :
       {std::pair{"Zm9v!m9v", 4}, {"Zg=v", 3}, {"=g==", 0}, {"Z===", 1}}) {
    Base64Reader reader(text);
    std::string bytes;
    EXPECT_FALSE(reader.read(std::string_view(text).size() / 4 * 3, bytes));
    ASSERT_TRUE(reader.bad_at()) << text;
    EXPECT_EQ(*reader.bad_at(), static_cast<std::size_t>(place)) << text;
  }
}

TEST(Base64, WhatIsEncodedComesBack) {
  EXPECT_TRUE(rc::check([](const std::string& bytes) {
    const std::string text = encode_base64(bytes);
    Base64Reader reader(text);
    RC_ASSERT(reader.remaining() >= bytes.size());
    std::string decoded;
    RC_ASSERT(reader.read(bytes.size(), decoded));
    RC_ASSERT(decoded == bytes);
  }));
}

}  // namespace
}  // namespace sinew::io
