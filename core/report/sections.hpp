// sections.hpp: the sections of a run's page, in the order a process engineer reads them.
#pragma once
#include <set>
#include <string>

#include "report/key_figures.hpp"
#include "report/page.hpp"

namespace calx {

/// What every section works from. drawn: sensors that have their charts already.
struct Sections {
  const RunFolder& run;
  const KeyFigures figures;
  Page& page;
  std::set<std::string> drawn{};

  void header();
  void overview();       // checks, assumptions, deviations, what is missing
  void pictures();       // stills, section, playback
  void lab();            // compression, tapping, wall and yield loci, flow function: what a powder laboratory draws
  void dosing();         // mass against time and cycle, flow
  void flow();           // lab plots of discharge, piles and drums
  void pile();           // height maps, other profiles, angle of repose against time
  void ledgers();        // energy and mass
  void loads();          // forces, torques, power on parts
  void other_sensors();  // whatever was not drawn yet
  void time_step();      // limits and speed
  void provenance();
  void case_text();

  /// One chart per unit of the sensor's columns, but for those named.
  std::string sensor_charts(const SensorSeries& sensor, const std::set<std::string>& leave_out = {});
  std::vector<ChartMark> event_marks() const;
  /// Sensors of that kind have their curves in flow().
  static bool is_flow_kind(const std::string& kind);
  /// The same for lab().
  static bool is_lab_kind(const std::string& kind);
  /// What the case has no sensor for, as a hint; nothing for a rig, whose own plots are what it is for.
  std::string without_sensor(const std::string& sentence) const;
};

}  // namespace calx
