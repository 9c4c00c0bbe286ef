// checkpoint.cpp: saves and restores everything that decides the bits of the steps to come.
//
// Rows that neither touch nor lie within a law's reach have no part in any sum, so the lists themselves are not saved:
// the order of particles, the margins and the positions of the last rebuild are, and the lists are built from those.
#include <algorithm>

#include "base/error.hpp"
#include "step/on_device.hpp"

namespace calx {

std::string Engine::history_layout() const {
  std::string text = options.mixed ? "mixed precision\n" : "";
  for (const LawList* list : laws) {
    if (!list) continue;
    text += list->label + ":";
    for (const auto& term : list->terms) {
      text += " " + term.name + "(" + term.id + ")[";
      for (std::uint32_t k = 0; k < term.table->state_count; ++k)
        text += std::string(k ? " " : "") + term.table->state[k].name + "{" + term.table->state[k].unit + "}";
      text += "]";
    }
    text += "\n";
  }
  return text;
}

void Engine::save(StateWriter& out) const {
  fetch();
  fetch_loads();
  pairs();  // brings both lists
  particles.save(out);
  out.put("lists/margin", margin_.data(), margin_.size(), "m");
  out.put("lists/reference", reinterpret_cast<const double*>(reference_.data()), reference_.size() * 3, "m");
  const std::uint64_t counts[] = {rebuilds_, sorted_at_, stale_, count_changed_};
  out.put("lists/counters", counts, 4);
  const double lengths[] = {smallest_margin_, largest_margin_, cell_, largest_overlap_};
  out.put("lists/lengths", lengths, 4, "m");
  out.put_text("contacts/layout", history_layout());
  std::vector<std::uint32_t> i, j;
  std::vector<double> column;
  for (std::size_t e = 0; e < pairs_.entry_count(); ++e)
    if (pairs_.touching[e]) {
      i.push_back(pairs_.i[e]);
      j.push_back(pairs_.j[e]);
    }
  out.put("contacts/pairs/i", i.data(), i.size());
  out.put("contacts/pairs/j", j.data(), j.size());
  for (std::uint32_t k = 0; k < history_.columns; ++k) {
    column.clear();
    for (std::size_t e = 0; e < pairs_.entry_count(); ++e)
      if (pairs_.touching[e]) column.push_back(pairs_.history[e * history_.columns + k]);
    out.put("contacts/pairs/history" + std::to_string(k), column.data(), column.size(), "see contacts/layout");
  }
  i.clear();
  j.clear();
  std::vector<double> normals;
  for (std::size_t s = 0; s < walls_.touching.size(); ++s)
    if (walls_.touching[s]) {
      i.push_back(walls_.sphere[s / kWallContacts]);
      j.push_back(walls_.part[s / kWallContacts]);
      for (int k = 0; k < 3; ++k) normals.push_back(walls_.normal[s][k]);
    }
  out.put("contacts/walls/sphere", i.data(), i.size());
  out.put("contacts/walls/part", j.data(), j.size());
  out.put("contacts/walls/normal", normals.data(), normals.size(), "1");
  for (std::uint32_t k = 0; k < history_.columns; ++k) {
    column.clear();
    for (std::size_t s = 0; s < walls_.touching.size(); ++s)
      if (walls_.touching[s]) column.push_back(walls_.history[k * walls_.stride + s]);
    out.put("contacts/walls/history" + std::to_string(k), column.data(), column.size(), "see contacts/layout");
  }
  const double sums[] = {energy_.kinetic_translation,
                         energy_.kinetic_rotation,
                         energy_.gravity,
                         energy_.elastic,
                         energy_.friction,
                         energy_.damping,
                         energy_.plastic,
                         energy_.wall_work,
                         energy_.force_work,
                         energy_.gravity_work,
                         energy_.wrapped};
  out.put("energy/sums", sums, 11, "J");
  if (rest_) rest_save(out);
}

void Engine::load(const StateReader& in) {
  if (in.get_text("contacts/layout") != history_layout())
    throw Error(
        Fault::files,
        "checkpoint: its contact history was written by other laws or in another precision; in the checkpoint:\n" +
            in.get_text("contacts/layout") + "in this case:\n" + history_layout());
  if (device_) device_->all_changed();
  particles.load(in);
  const auto margins = in.get_doubles("lists/margin"), reference = in.get_doubles("lists/reference"),
             lengths = in.get_doubles("lists/lengths"), sums = in.get_doubles("energy/sums");
  const auto counts = in.get_u64("lists/counters");
  margin_.assign(margins.begin(), margins.end());
  reference_.resize(reference.size() / 3);
  for (std::size_t k = 0; k < reference_.size(); ++k)
    reference_[k] = {reference[3 * k], reference[3 * k + 1], reference[3 * k + 2]};
  smallest_margin_ = lengths[0];
  largest_margin_ = lengths[1];
  cell_ = lengths[2];
  largest_overlap_ = lengths[3];
  energy_ = {sums[0], sums[1], sums[2], sums[3], sums[4], sums[5], sums[6], sums[7], sums[8], sums[9], sums[10]};
  uniform_ = one_material();
  measure_gaps();
  // Lists of what this engine may have run before must not lend their history.
  pairs_ = {};
  walls_ = {};
  const std::size_t spheres = particles.sphere_count();
  list_rank_.resize(spheres);
  for (std::uint32_t k = 0; k < spheres; ++k) list_rank_[k] = k;
  reference_.resize(spheres);

  // Particles that came since the last rebuild have no margin yet; the flags below ask for a rebuild at once.
  const bool fresh = counts[2] != 0 && margin_.size() != particles.count();
  margin_.resize(particles.count(), largest_margin_);
  Record* s = particles.spheres();
  std::vector<Vec3> now(spheres);
  for (std::size_t k = 0; k < spheres; ++k) {
    now[k] = position(s[k]);
    if (!fresh) s[k].x = reference_[k].x, s[k].y = reference_[k].y, s[k].z = reference_[k].z;
  }
  pairs_.build(particles, options.wrap, margin_, history_, nullptr, largest_pair_gap_);
  for (std::size_t k = 0; k < spheres; ++k) s[k].x = now[k].x, s[k].y = now[k].y, s[k].z = now[k].z;
  place_parts(0, places_);
  walls_.build(particles, pairs_, places_, margin_, 2, history_, nullptr, largest_wall_gap_);
  size_sums();
  set_haste();
  used_.assign(pairs_.chunks.size(), 1);  // not known: the first step looks at every particle
  rebuilds_ = counts[0];
  sorted_at_ = counts[1];
  stale_ = counts[2] != 0;
  count_changed_ = counts[3] != 0;

  // Laws may reach less far than those that wrote the checkpoint: what they would no longer see has ended.
  const bool reaches = std::any_of(laws.begin(), laws.end(), [](const LawList* list) { return list && list->reaches; });
  const auto i = in.get_u32("contacts/pairs/i"), j = in.get_u32("contacts/pairs/j");
  std::vector<std::vector<double>> columns(history_.columns);
  for (std::uint32_t k = 0; k < history_.columns; ++k)
    columns[k] = in.get_doubles("contacts/pairs/history" + std::to_string(k));
  for (std::size_t c = 0, e = 0; c < i.size(); ++c) {
    while (e < pairs_.entry_count() && (pairs_.i[e] < i[c] || (pairs_.i[e] == i[c] && pairs_.j[e] < j[c]))) ++e;
    const bool listed = e < pairs_.entry_count() && pairs_.i[e] == i[c] && pairs_.j[e] == j[c];
    if (!listed && reaches) continue;
    if (!listed)
      throw Error(Fault::files, "checkpoint: a contact stands between spheres that are far apart; the file is damaged");
    pairs_.touching[e] = 1;
    for (std::uint32_t k = 0; k < history_.columns; ++k) pairs_.history[e * history_.columns + k] = columns[k][c];
  }
  const auto sphere = in.get_u32("contacts/walls/sphere"), part = in.get_u32("contacts/walls/part");
  const auto normals = in.get_doubles("contacts/walls/normal");
  for (std::uint32_t k = 0; k < history_.columns; ++k)
    columns[k] = in.get_doubles("contacts/walls/history" + std::to_string(k));
  std::size_t row = 0;
  std::uint32_t used = 0;
  for (std::size_t c = 0; c < sphere.size(); ++c) {
    used = c > 0 && sphere[c] == sphere[c - 1] && part[c] == part[c - 1] ? used + 1 : 0;
    while (row < walls_.row_count() &&
           (walls_.sphere[row] < sphere[c] || (walls_.sphere[row] == sphere[c] && walls_.part[row] < part[c])))
      ++row;
    const bool listed = row < walls_.row_count() && walls_.sphere[row] == sphere[c] && walls_.part[row] == part[c];
    if (!listed && reaches) continue;
    if (!listed || used >= kWallContacts)
      throw Error(Fault::files, "checkpoint: a wall contact stands far from its part; the file is damaged");
    const std::size_t slot = row * kWallContacts + used;
    walls_.touching[slot] = 1;
    walls_.normal[slot] = {normals[3 * c], normals[3 * c + 1], normals[3 * c + 2]};
    for (std::uint32_t k = 0; k < history_.columns; ++k) walls_.history[k * walls_.stride + slot] = columns[k][c];
  }
  if (rest_) rest_load(in);
}

}  // namespace calx
