// sha256.hpp: SHA-256 (FIPS 180-4) as 64 lower-case hex digits, for plugin pins and provenance.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace calx {

/// For data that comes in pieces; finish() once.
class Sha256 {
 public:
  void add(const void* data, std::size_t bytes);
  std::string finish();

 private:
  void block(const unsigned char* p);
  std::uint32_t h_[8] = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  unsigned char buffer_[64] = {};
  std::size_t filled_ = 0;
  std::uint64_t total_ = 0;
};

std::string sha256(const void* data, std::size_t bytes);
std::string sha256(const std::string& bytes);
/// Throws Error(Fault::files) when the file cannot be read.
std::string sha256_file(const std::string& path);

}  // namespace calx
