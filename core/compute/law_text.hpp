// law_text.hpp: the laws of a case as one function of device text, which kernels call for each contact.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "compute/device_text.hpp"
#include "compute/law_list.hpp"

namespace calx {

/// What kernels need to evaluate contacts.
struct LawProgram {
  std::vector<TextPart> laws;         // texts of the plugins, each once
  std::string text;                   // the function CALX_ID(calx_contact_laws), in the precision of the laws before it
  std::vector<double> numbers;        // pair rows and presets that it reads
  std::vector<std::uint32_t> law_of;  // per ordered material pair: number of its list, kNoLaw where there is none
  bool reaches = false;               // some list acts between surfaces that do not touch
  static constexpr std::uint32_t kNoLaw = 0xFFFFFFFFu;
};

/// laws: per ordered material pair, null where the case gives none. Terms add up in the order of their list, as in
/// evaluate_block. Every law must have a text; see laws_without_text.
LawProgram law_program(const std::vector<const LawList*>& laws);

/// Ids of laws whose plugin brings native code but no text, each once.
std::vector<std::string> laws_without_text(const std::vector<const LawList*>& laws);

}  // namespace calx
