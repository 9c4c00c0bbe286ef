// case_reader.hpp: one reading of a Document into CaseSettings. Private to this module; each group of sections has its
// own source file: case_particles.cpp, case_machine.cpp, case_events.cpp, case_run.cpp, case_regions.cpp,
// case_scale.cpp.
#pragma once
#include <string>
#include <vector>

#include "config/node.hpp"
#include "config/settings.hpp"

namespace calx {

class CaseReader {
 public:
  explicit CaseReader(Document& document) : document_(document) {}
  CaseSettings read();
  /// A region under "regions", for what looks at a case before it is read.
  static RegionSettings named_region(Document& document, const std::string& name);

 private:
  /// Names that other sections may refer to, collected before any section is read.
  struct Names {
    std::vector<std::string> materials, shapes, regions, parts, motions, events;
  };
  void collect_names(const Node& root);

  // case_particles.cpp
  void read_materials(Object& root);
  void read_contacts(Object& root);
  void read_shapes(Object& root);
  void read_sources(Object& root);
  void read_source_amount(Object& source, SourceSettings& s);
  void read_positions(Object& source, SourceSettings& s);
  SizeSettings read_size(const Node& node);

  // case_machine.cpp
  void read_parts(Object& root);
  void read_motions(Object& root);
  void read_stages(Object& root);
  void read_forces(Object& root);
  void read_sensors(Object& root);
  void read_instruments(const Node& sensor, SensorSettings& s);

  // case_events.cpp
  void read_events(Object& root);
  /// The name of the event that node names or describes; one described inline is added under made_up.
  std::string event(const Node& node, const std::string& made_up);
  ConditionSettings condition(const Node& node);
  void check_event_cycles() const;

  // case_regions.cpp
  void read_regions(Object& root);
  RegionSettings region(const Node& node, const std::string& name);
  /// The name of the region that node names or describes; one described inline is added under made_up.
  std::string region_name(const Node& node, const std::string& made_up);

  // case_run.cpp
  void read_domain(Object& root);
  void read_time(Object& root);
  void read_output(Object& root);
  void read_rest(Object& root);
  void read_plugins(Object& root);
  void read_effects(Object& root);

  // case_scale.cpp
  void read_scale(Object& root);

  Document& document_;
  Names names_;
  CaseSettings case_;
};

}  // namespace calx
