// pair_pass.cpp: contacts between spheres: distance test, block of columns, laws, scatter.
#include "step/engine_detail.hpp"

namespace calx {
namespace {

/// Contact kinematics of a block, in columns. The contact point lies in the middle of the overlap; lever arms are
/// r - overlap/2. Velocity: that of i relative to j at the contact point. Returns the largest overlap / (2 r_eff).
CALX_HOT double kinematics(std::uint32_t n, const double* __restrict dx, const double* __restrict dy,
                           const double* __restrict dz, const double* __restrict ri, const double* __restrict rj,
                           const double* __restrict mi, const double* __restrict mj, const double* __restrict wix,
                           const double* __restrict wiy, const double* __restrict wiz, const double* __restrict wjx,
                           const double* __restrict wjy, const double* __restrict wjz, double* __restrict vx,
                           double* __restrict vy, double* __restrict vz, double* __restrict overlap,
                           double* __restrict nx, double* __restrict ny, double* __restrict nz, double* __restrict re,
                           double* __restrict me, double* __restrict ai, double* __restrict aj) {
  double largest = 0;
#pragma omp simd reduction(max : largest)
  for (std::uint32_t k = 0; k < n; ++k) {
    const double d = std::sqrt(dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k]);
    const double inverse = 1 / d;
    const double x = dx[k] * inverse, y = dy[k] * inverse, z = dz[k] * inverse;
    const double o = ri[k] + rj[k] - d;
    const double a = ri[k] - 0.5 * o, b = rj[k] - 0.5 * o;
    // v_i + w_i x (-a n) - v_j - w_j x (b n) = v_i - v_j - (a w_i + b w_j) x n
    const double sx = a * wix[k] + b * wjx[k], sy = a * wiy[k] + b * wjy[k], sz = a * wiz[k] + b * wjz[k];
    vx[k] -= sy * z - sz * y;
    vy[k] -= sz * x - sx * z;
    vz[k] -= sx * y - sy * x;
    nx[k] = x;
    ny[k] = y;
    nz[k] = z;
    overlap[k] = o;
    const double r = ri[k] * rj[k] / (ri[k] + rj[k]);
    re[k] = r;
    me[k] = mi[k] * mj[k] / (mi[k] + mj[k]);
    ai[k] = a;
    aj[k] = b;
    const double share = 0.5 * o / r;
    largest = share > largest ? share : largest;
  }
  return largest;
}

/// g = n x f.
CALX_HOT void lever(std::uint32_t n, const double* __restrict nx, const double* __restrict ny,
                    const double* __restrict nz, const double* __restrict fx, const double* __restrict fy,
                    const double* __restrict fz, double* __restrict gx, double* __restrict gy, double* __restrict gz) {
#pragma omp simd
  for (std::uint32_t k = 0; k < n; ++k) {
    gx[k] = ny[k] * fz[k] - nz[k] * fy[k];
    gy[k] = nz[k] * fx[k] - nx[k] * fz[k];
    gz[k] = nx[k] * fy[k] - ny[k] * fx[k];
  }
}

}  // namespace

void Engine::pair_pass(std::size_t c, Worker& w, double t, double dt) {
  const Chunk& chunk = pairs_.chunks[c];
  ChunkResult& result = results_[c];
  const Record* __restrict s = particles.spheres();
  const std::uint32_t* __restrict pi = pairs_.i.data();
  const std::uint32_t* __restrict pj = pairs_.j.data();
  std::uint8_t* __restrict touch = pairs_.touching.data();
  std::fill(sphere_wrench_.begin() + chunk.first_sphere, sphere_wrench_.begin() + chunk.last_sphere, Wrench{});
  std::fill(pairs_.slot_used.begin() + static_cast<std::ptrdiff_t>(chunk.first_slot),
            pairs_.slot_used.begin() + static_cast<std::ptrdiff_t>(chunk.last_slot), std::uint8_t{0});
  const bool wraps = options.wrap.any();
  w.cross_done = pairs_.first_cross[c];
  for (std::size_t e0 = chunk.first_entry; e0 < chunk.last_entry; e0 += kBlockRows) {
    const auto rows = static_cast<std::uint32_t>(std::min<std::size_t>(kBlockRows, chunk.last_entry - e0));
    w.tile = e0;
    std::uint32_t n = 0, crossed = 0;
    for (std::uint32_t k = 0; k < rows; ++k) {
      const Record& a = s[pi[e0 + k]];
      const Record& b = s[pj[e0 + k]];
      Vec3 d{a.x - b.x, a.y - b.y, a.z - b.z};
      if (wraps) d = options.wrap.nearest(d);
      const double reach = a.r + b.r;
      const bool hit = d.x * d.x + d.y * d.y + d.z * d.z < reach * reach;
      w.entry[n] = k;
      w.ordinal[n] = crossed;
      n += hit;
      crossed += pj[e0 + k] >= chunk.last_sphere;
      // A row that is not touching any more starts afresh next time.
      touch[e0 + k] = static_cast<std::uint8_t>(touch[e0 + k] & hit);
    }
    result.touching += n;
    if (n > 0 && uniform_) {
      std::copy(w.entry, w.entry + n, w.picked);
      std::copy(w.ordinal, w.ordinal + n, w.picked_ordinal);
      evaluate_pairs(c, w, law(particles.material[0], particles.material[0]), n, t, dt);
    } else if (n > 0) {
      for (std::uint32_t k = 0; k < n; ++k) {
        const std::size_t e = e0 + w.entry[k];
        w.bucket[k] = particles.material[particles.owner_of(pi[e])] * material_count +
                      particles.material[particles.owner_of(pj[e])];
      }
      for (std::uint32_t b = 0; b < laws.size(); ++b) {
        std::uint32_t m = 0;
        for (std::uint32_t k = 0; k < n; ++k) {
          w.picked[m] = w.entry[k];
          w.picked_ordinal[m] = w.ordinal[k];
          m += w.bucket[k] == b;
        }
        if (m > 0) evaluate_pairs(c, w, law(b / material_count, b % material_count), m, t, dt);
      }
    }
    w.cross_done += crossed;
  }
}

void Engine::evaluate_pairs(std::size_t c, Worker& w, const LawList& list, std::uint32_t n, double t, double dt) {
  const Chunk& chunk = pairs_.chunks[c];
  ChunkResult& result = results_[c];
  BlockScratch& block = w.scratch;
  block.count = n;
  const Record* __restrict s = particles.spheres();
  const std::size_t e0 = w.tile;
  const std::uint32_t* __restrict pi = pairs_.i.data() + e0;
  const std::uint32_t* __restrict pj = pairs_.j.data() + e0;
  double* __restrict vx = block.in(CALX_IN_VX);
  double* __restrict vy = block.in(CALX_IN_VY);
  double* __restrict vz = block.in(CALX_IN_VZ);
  const bool wraps = options.wrap.any();
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t i = pi[w.picked[k]], j = pj[w.picked[k]];
    const Record& a = s[i];
    const Record& b = s[j];
    w.i[k] = i;
    w.j[k] = j;
    w.dx[k] = a.x - b.x;
    w.dy[k] = a.y - b.y;
    w.dz[k] = a.z - b.z;
    w.ri[k] = a.r;
    w.rj[k] = b.r;
    w.mi[k] = a.m;
    w.mj[k] = b.m;
    vx[k] = a.vx - b.vx;
    vy[k] = a.vy - b.vy;
    vz[k] = a.vz - b.vz;
    w.wix[k] = a.wx;
    w.wiy[k] = a.wy;
    w.wiz[k] = a.wz;
    w.wjx[k] = b.wx;
    w.wjy[k] = b.wy;
    w.wjz[k] = b.wz;
  }
  if (wraps)
    for (std::uint32_t k = 0; k < n; ++k) {
      const Vec3 d = options.wrap.nearest({w.dx[k], w.dy[k], w.dz[k]});
      w.dx[k] = d.x;
      w.dy[k] = d.y;
      w.dz[k] = d.z;
    }
  double* nx = block.in(CALX_IN_NX);
  double* ny = block.in(CALX_IN_NY);
  double* nz = block.in(CALX_IN_NZ);
  const double share = kinematics(n, w.dx, w.dy, w.dz, w.ri, w.rj, w.mi, w.mj, w.wix, w.wiy, w.wiz, w.wjx, w.wjy, w.wjz,
                                  vx, vy, vz, block.in(CALX_IN_OVERLAP), nx, ny, nz, block.in(CALX_IN_R_EFF),
                                  block.in(CALX_IN_M_EFF), w.arm_i, w.arm_j);
  if (share > result.largest_overlap) {
    result.largest_overlap = share;
    for (std::uint32_t k = 0; k < n; ++k)
      if (0.5 * block.in(CALX_IN_OVERLAP)[k] / block.in(CALX_IN_R_EFF)[k] >= share) {
        result.overlap_i = w.i[k];
        result.overlap_j = w.j[k];
        break;
      }
  }
  if (list.needs & 7u << CALX_IN_WX) {
    double* wx = block.in(CALX_IN_WX);
    double* wy = block.in(CALX_IN_WY);
    double* wz = block.in(CALX_IN_WZ);
    for (std::uint32_t k = 0; k < n; ++k) {
      wx[k] = w.wix[k] - w.wjx[k];
      wy[k] = w.wiy[k] - w.wjy[k];
      wz[k] = w.wiz[k] - w.wjz[k];
    }
  }
  if (list.needs & 3u << CALX_IN_R_I) {
    std::copy(w.ri, w.ri + n, block.in(CALX_IN_R_I));
    std::copy(w.rj, w.rj + n, block.in(CALX_IN_R_J));
  }

  std::uint8_t* __restrict touch = pairs_.touching.data() + e0;
  double* __restrict history = pairs_.history.data() + e0;
  for (std::uint32_t h = 0; h < list.state_count; ++h) {
    const double* __restrict column = history + h * pairs_.stride;
    double* __restrict state = block.state(h);
    const double preset = list.preset[h];
    for (std::uint32_t k = 0; k < n; ++k) state[k] = touch[w.picked[k]] ? column[w.picked[k]] : preset;
  }
  for (std::uint32_t k = 0; k < n; ++k) touch[w.picked[k]] = 1;

  evaluate_block(list, block, dt, t, options.ledger);

  for (std::uint32_t h = 0; h < list.state_count; ++h) {
    double* __restrict column = history + h * pairs_.stride;
    const double* __restrict state = block.state(h);
    for (std::uint32_t k = 0; k < n; ++k) column[w.picked[k]] = state[k];
  }
  const double* __restrict fx = block.out(CALX_OUT_FX);
  const double* __restrict fy = block.out(CALX_OUT_FY);
  const double* __restrict fz = block.out(CALX_OUT_FZ);
  const double* __restrict mx = block.out(CALX_OUT_MX);
  const double* __restrict my = block.out(CALX_OUT_MY);
  const double* __restrict mz = block.out(CALX_OUT_MZ);
  lever(n, nx, ny, nz, fx, fy, fz, w.gx, w.gy, w.gz);

  Wrench* __restrict sums = sphere_wrench_.data();
  for (std::uint32_t k = 0; k < n; ++k) {
    Wrench& a = sums[w.i[k]];
    const double ai = w.arm_i[k], aj = w.arm_j[k];
    a.fx += fx[k];
    a.fy += fy[k];
    a.fz += fz[k];
    a.tx += mx[k] - ai * w.gx[k];
    a.ty += my[k] - ai * w.gy[k];
    a.tz += mz[k] - ai * w.gz[k];
    const std::uint32_t j = w.j[k];
    if (j < chunk.last_sphere) {
      Wrench& b = sums[j];
      b.fx -= fx[k];
      b.fy -= fy[k];
      b.fz -= fz[k];
      b.tx -= mx[k] + aj * w.gx[k];
      b.ty -= my[k] + aj * w.gy[k];
      b.tz -= mz[k] + aj * w.gz[k];
    } else {
      const std::uint32_t slot = pairs_.cross[w.cross_done + w.picked_ordinal[k]];
      pairs_.slot_used[slot] = 1;
      pairs_.slot_wrench[slot] = {
          -fx[k], -fy[k], -fz[k], -(mx[k] + aj * w.gx[k]), -(my[k] + aj * w.gy[k]), -(mz[k] + aj * w.gz[k])};
    }
  }
  if (!options.ledger) return;
  for (std::uint32_t k = 0; k < n; ++k) {
    result.elastic += block.out(CALX_OUT_ELASTIC)[k];
    result.friction += block.out(CALX_OUT_FRICTION)[k];
    result.damping += block.out(CALX_OUT_DAMPING)[k];
    result.plastic += block.out(CALX_OUT_PLASTIC)[k];
  }
}

}  // namespace calx
