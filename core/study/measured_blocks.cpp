#include "study/measured_blocks.hpp"

#include <algorithm>
#include <cmath>

namespace calx {
namespace {

using infer::Block;
using infer::Vector;
using Use = StudyObservable::Use;

/// An sd from n numbers is itself uncertain: with it, a normal number has tails of t with n - 1 degrees of freedom,
/// whose variance is larger by (n - 1) / (n - 3). Bounded, since two or three numbers give none.
double widening(const StudyObservable& o) {
  if (!o.measured.sd_estimated) return 1;
  const double freedom = static_cast<double>((o.measured.repeats - 1) * o.measured.y.size());
  constexpr double most = 4;
  return std::sqrt(freedom > 2 ? std::min(most, freedom / (freedom - 2)) : most);
}

Vector sd_of_mean(const StudyObservable& o, std::size_t repeats) {
  return vector_of(o.measured.sd) * widening(o) / std::sqrt(static_cast<double>(repeats));
}

Block block_of(const StudyObservable& o) {
  Block b;
  b.name = o.name, b.kind = o.kind;
  b.x = o.against.empty() ? Vector(Vector::Zero(1)) : vector_of(o.measured.x);
  const bool over_stress = o.kind == "compressibility" || o.kind == "wall-friction" || o.kind == "shear";
  b.log_x = over_stress && b.x.size() > 1 && b.x[0] > 0;
  b.ordered = o.against == "time_s" || o.against.find("cycle") != std::string::npos;
  b.autocorrelation = o.measured.correlation;
  b.sd = sd_of_mean(o, o.measured.repeats);
  b.tolerance = o.tolerance / b.sd.mean();
  if (!o.simulated.empty()) b.base_sd = o.simulated_sd / b.sd.mean();
  (o.use == Use::fit ? b.fit : b.hold) = vector_of(o.measured.y);
  return b;
}

bool same_reading(const StudyObservable& a, const StudyObservable& b) {
  return a.case_name == b.case_name && a.sensor == b.sensor && a.column == b.column && a.against == b.against &&
         a.unit == b.unit && a.kind == b.kind && a.measured.x == b.measured.x && a.use != b.use &&
         a.scan.low_x == b.scan.low_x && a.scan.high_x == b.scan.high_x && a.scan.low_y == b.scan.low_y &&
         a.scan.high_y == b.scan.high_y;
}

/// Two campaigns in one block need one sd; where they differ more than this, they stay apart.
bool join(Block& to, const Block& other) {
  const double ratio = other.sd.mean() / to.sd.mean();
  if (ratio > 2 || ratio < 0.5) return false;
  const double tolerance = to.tolerance * to.sd.mean();
  to.sd = ((to.sd.cwiseAbs2() + other.sd.cwiseAbs2()) / 2).cwiseSqrt();
  to.tolerance = tolerance / to.sd.mean();
  to.autocorrelation = (to.autocorrelation + other.autocorrelation) / 2;
  (to.fit.size() == 0 ? to.fit : to.hold) = to.fit.size() == 0 ? other.fit : other.hold;
  return true;
}

/// The later half of the repeats becomes the held-out campaign.
bool split(Block& block, const StudyObservable& o) {
  const std::vector<std::vector<double>>& each = o.measured.each;
  // Two scalars a campaign at least, so that one odd repeat is not a campaign; a curve holds many numbers by itself.
  const std::size_t needed = o.measured.y.size() > 4 ? 2 : 4;
  if (each.size() < needed) return false;
  const std::size_t first = (each.size() + 1) / 2, second = each.size() - first;
  Vector fit = Vector::Zero(block.sd.size()), hold = fit;
  for (std::size_t k = 0; k < each.size(); ++k)
    (k < first ? fit : hold) += vector_of(each[k]) / static_cast<double>(k < first ? first : second);
  const double tolerance = block.tolerance * block.sd.mean();
  block.sd = sd_of_mean(o, second);
  block.tolerance = tolerance / block.sd.mean();
  block.fit = fit, block.hold = hold;
  return true;
}

}  // namespace

infer::Vector vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
}

MeasuredBlocks measured_blocks(const Study& study) {
  MeasuredBlocks out;
  std::vector<Block>& blocks = out.observables.blocks;
  for (const StudyObservable& o : study.observables) {
    const Block block = block_of(o);
    const auto partner = std::find_if(out.readings.begin(), out.readings.end(),
                                      [&](const StudyObservable& r) { return same_reading(r, o); });
    if (partner != out.readings.end()) {
      const auto number = static_cast<std::size_t>(partner - out.readings.begin());
      Block& to = blocks[number];
      if ((to.fit.size() == 0 || to.hold.size() == 0) && join(to, block)) {
        out.block_of.push_back(number);
        continue;
      }
    }
    out.block_of.push_back(blocks.size());
    out.readings.push_back(o);
    blocks.push_back(block);
  }
  // What is delivered cycle by cycle adds up to what the vessel holds, so that a change of the one shows in the other.
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (std::size_t k = 0; k < blocks.size() && blocks[b].kind == "mass-after-cycles" && blocks[b].x.size() > 1; ++k)
      if (blocks[k].kind == "mass-per-cycle" && blocks[k].x.size() > 1 &&
          out.readings[k].unit == out.readings[b].unit && out.readings[k].case_name == out.readings[b].case_name)
        blocks[b].sums = blocks[k].name;
  out.has_hold_out = std::any_of(blocks.begin(), blocks.end(), [](const Block& b) { return b.hold.size() != 0; });
  if (out.has_hold_out) return out;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (split(blocks[b], out.readings[b])) out.split_repeats = out.has_hold_out = true;
  return out;
}

}  // namespace calx
