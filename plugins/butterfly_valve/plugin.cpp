#include "butterfly_valve.hpp"

CALX_PLUGIN(Disc, Housing)
