#include "step/on_device_text.hpp"

namespace calx {

ModuleText step_text(const LawProgram& laws, const ForceProgram& forces, bool mixed, bool fast) {
  ModuleText text;
  text.label = "step";
  text.fast = fast;
  if (laws.reaches) text.defines.push_back("CALX_REACHES=1");
  text.add("world.h");
  if (mixed) {
    text.add_laws(32, laws.laws);
    text.add("laws of the case", laws.text);
    text.add("contacts.h");
  }
  text.add_laws(64, laws.laws);
  text.add("laws of the case", laws.text);
  for (const TextPart& force : forces.forces) text.add(force.name, force.text);
  text.add("forces of the case", forces.text);
  for (const char* part : {"contacts.h", "surfaces.h", "walls.h", "forces.h", "motion.h", "fold.h"}) text.add(part);
  return text;
}

ModuleText list_text() {
  ModuleText text;
  text.label = "lists";
  for (const char* part : {"world.h", "order.h", "pairs.h", "surfaces.h", "rows.h"}) text.add(part);
  return text;
}

}  // namespace calx
