#include "core/sha256.h"

#include <gtest/gtest.h>

namespace slipway {
namespace {

std::string digest_of(const std::string& text) {
  Sha256 hash;
  hash.add(text);
  return hash.digest();
}

// The examples of FIPS 180-4, and a million letters in pieces.
TEST(Sha256, GivesTheStandardsExamples) {
  EXPECT_EQ(digest_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(digest_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(digest_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  Sha256 million;
  for (int piece = 0; piece < 1000; ++piece) million.add(std::string(1000, 'a'));
  EXPECT_EQ(million.digest(), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

}  // namespace
}  // namespace slipway
