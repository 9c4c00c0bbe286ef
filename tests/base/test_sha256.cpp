// SHA-256 against the examples of FIPS 180-4 and of the NIST test vectors.
#include <doctest/doctest.h>

#include <cstdio>
#include <fstream>

#include "base/error.hpp"
#include "base/sha256.hpp"

using namespace calx;

TEST_CASE("published digests come out") {
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256(std::string(1000000, 'a')) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_CASE("pieces of any length give the digest of the whole") {
  const std::string text(1000, 'x');
  for (const std::size_t piece : {1u, 7u, 63u, 64u, 65u, 129u}) {
    Sha256 s;
    for (std::size_t at = 0; at < text.size(); at += piece) s.add(text.data() + at, std::min(piece, text.size() - at));
    CHECK(s.finish() == sha256(text));
  }
}

TEST_CASE("a file has the digest of its bytes, a missing one is an error") {
  const std::string path = "sha256_test.tmp";
  std::ofstream(path, std::ios::binary) << "abc";
  CHECK(sha256_file(path) == sha256("abc"));
  std::remove(path.c_str());
  CHECK_THROWS_WITH(sha256_file(path), "sha256_test.tmp: cannot be read for its SHA-256; No such file or directory");
}
