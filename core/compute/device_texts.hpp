// device_texts.hpp: the texts that device_texts.cmake puts into the library.
#pragma once
#include <string_view>
#include <vector>

namespace calx {

struct EmbeddedText {
  std::string_view name, text;
};

/// Sorted by path.
const std::vector<EmbeddedText>& embedded_texts();

}  // namespace calx
