// creator.hpp: what the files of a run say about the program that wrote them.
#pragma once

namespace calx {

constexpr char creator_name[] = "calx";
constexpr char creator_version[] = "0.1.0";

}  // namespace calx
