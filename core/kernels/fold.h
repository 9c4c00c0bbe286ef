/* fold.h: energies, loads on parts, counters and the largest overlap of a step: first of spans of SPAN spheres or
 * particles of a chunk, then of chunks, always in rank order. The host adds in the same spans. A contact belongs to its
 * first sphere, so that no sum depends on what lists hold beside contacts. */
#ifndef CALX_FOLD_H
#define CALX_FOLD_H

/* A chunk, and where its spans of particles and of spheres begin in the lists of all spans. */
typedef struct chunk {
  u32 first_particle, last_particle, first_sphere, last_sphere, first_particle_span, first_sphere_span;
} chunk;

#define SPAN 64u

/* One item: the table of chunks of chunk_length particles, and the numbers of all spans of particles and of spheres. */
KERNEL(make_chunks, u32 particles, u32 chunk_length, u32 chunks, u32 clumps, GLOBAL const u32* RESTRICT first_sphere,
       GLOBAL chunk* RESTRICT out, GLOBAL u32* RESTRICT spans) {
  if (ITEM > 0) return;
  u32 particle_spans = 0, sphere_spans = 0;
  for (u32 c = 0; c < chunks; ++c) {
    chunk k;
    k.first_particle = c * chunk_length;
    k.last_particle = MIN(particles, k.first_particle + chunk_length);
    k.first_sphere = clumps ? first_sphere[k.first_particle] : k.first_particle;
    k.last_sphere = clumps ? first_sphere[k.last_particle] : k.last_particle;
    k.first_particle_span = particle_spans;
    k.first_sphere_span = sphere_spans;
    particle_spans += (k.last_particle - k.first_particle + SPAN - 1) / SPAN;
    sphere_spans += (k.last_sphere - k.first_sphere + SPAN - 1) / SPAN;
    out[c] = k;
  }
  spans[0] = particle_spans;
  spans[1] = sphere_spans;
}

/* Sums of a span or chunk. */
#define SUM_ELASTIC 0u
#define SUM_FRICTION 1u
#define SUM_DAMPING 2u
#define SUM_PLASTIC 3u
#define SUM_TOUCHING 4u
#define SUM_LARGEST 5u /* overlap, share of the radius */
#define SUM_LARGEST_I 6u
#define SUM_LARGEST_J 7u /* a sphere, or 2^32 - 1 - part */
#define SUM_WALL_WORK 8u
#define SUM_TRANSLATION 9u
#define SUM_ROTATION 10u
#define SUM_GRAVITY 11u
#define SUM_GRAVITY_WORK 12u
#define SUM_FORCE_WORK 13u
#define SUMS 14u /* then six for each part: load, N and N m about the pivot */

/* Number of the chunk that span k belongs to; firsts rise. */
#define CHUNK_OF_SPAN(member)           \
  u32 c = 0, after = n.chunks;          \
  while (after - c > 1) {               \
    const u32 middle = (c + after) / 2; \
    if (chunks[middle].member <= span)  \
      c = middle;                       \
    else                                \
      after = middle;                   \
  }

KERNEL(fold_pairs, step_numbers n, u32 spans, GLOBAL const chunk* RESTRICT chunks, GLOBAL const u32* RESTRICT first,
       GLOBAL const u32* RESTRICT second, GLOBAL const u32* RESTRICT row_first, GLOBAL const u8* RESTRICT touching,
       GLOBAL const double* RESTRICT share, GLOBAL const double* RESTRICT energy, GLOBAL double* RESTRICT out,
       GLOBAL const u32* RESTRICT flags) {
  const u32 span = ITEM;
  if (span >= spans || flags[FLAG_STOP]) return;
  CHUNK_OF_SPAN(first_sphere_span)
  const u32 sphere = chunks[c].first_sphere + (span - chunks[c].first_sphere_span) * SPAN;
  const u32 from = row_first[sphere], to = row_first[MIN(chunks[c].last_sphere, sphere + SPAN)];
  double elastic = 0.0, friction = 0.0, damping = 0.0, plastic = 0.0, largest = 0.0;
  u32 touches = 0, where = from;
  const u64 stride = n.entries;
  for (u32 e = from; e < to; ++e) {
    if (!touching[e]) continue;
#ifdef CALX_REACHES
    touches += share[e] > 0.0;
#else
    ++touches;
#endif
    if (share[e] > largest) {
      largest = share[e];
      where = e;
    }
    if (!n.ledger) continue;
    elastic += energy[e];
    friction += energy[stride + e];
    damping += energy[2 * stride + e];
    plastic += energy[3 * stride + e];
  }
  GLOBAL double* sums = out + (u64)span * SUMS;
  sums[SUM_ELASTIC] = elastic;
  sums[SUM_FRICTION] = friction;
  sums[SUM_DAMPING] = damping;
  sums[SUM_PLASTIC] = plastic;
  sums[SUM_TOUCHING] = (double)touches;
  sums[SUM_LARGEST] = largest;
  sums[SUM_LARGEST_I] = largest > 0.0 ? (double)first[where] : 0.0;
  sums[SUM_LARGEST_J] = largest > 0.0 ? (double)second[where] : 0.0;
}

KERNEL(fold_walls, step_numbers n, u32 spans, GLOBAL const chunk* RESTRICT chunks,
       GLOBAL const u32* RESTRICT wall_first, GLOBAL const u32* RESTRICT row_sphere,
       GLOBAL const u32* RESTRICT row_part, GLOBAL const u32* RESTRICT counts, GLOBAL const double* RESTRICT values,
       GLOBAL const double* RESTRICT share, GLOBAL const double* RESTRICT energy, GLOBAL double* RESTRICT out,
       GLOBAL const u32* RESTRICT flags) {
  const u32 span = ITEM;
  if (span >= spans || flags[FLAG_STOP]) return;
  CHUNK_OF_SPAN(first_sphere_span)
  const u32 sphere = chunks[c].first_sphere + (span - chunks[c].first_sphere_span) * SPAN;
  const u32 from = wall_first[sphere], to = wall_first[MIN(chunks[c].last_sphere, sphere + SPAN)];
  double elastic = 0.0, friction = 0.0, damping = 0.0, plastic = 0.0, work = 0.0, largest = 0.0;
  u32 touches = 0, where = from;
  const u64 stride = (u64)n.wall_rows * WALL_CONTACTS;
  GLOBAL double* sums = out + (u64)span * (SUMS + 6u * n.parts);
  GLOBAL double* loads = sums + SUMS;
  for (u32 k = 0; k < 6u * n.parts; ++k) loads[k] = 0.0;
  for (u32 row = from; row < to; ++row) {
    GLOBAL double* load = loads + 6u * row_part[row];
    for (u32 k = 0; k < counts[row]; ++k) {
      const u64 at = (u64)row * WALL_CONTACTS + k;
      touches += share[at] > 0.0;
      if (share[at] > largest) {
        largest = share[at];
        where = row;
      }
      load[0] += -values[at];
      load[1] += -values[stride + at];
      load[2] += -values[2 * stride + at];
      load[3] += -values[6 * stride + at];
      load[4] += -values[7 * stride + at];
      load[5] += -values[8 * stride + at];
      work += values[9 * stride + at];
      if (!n.ledger) continue;
      elastic += energy[at];
      friction += energy[stride + at];
      damping += energy[2 * stride + at];
      plastic += energy[3 * stride + at];
    }
  }
  sums[SUM_ELASTIC] = elastic;
  sums[SUM_FRICTION] = friction;
  sums[SUM_DAMPING] = damping;
  sums[SUM_PLASTIC] = plastic;
  sums[SUM_TOUCHING] = (double)touches;
  sums[SUM_LARGEST] = largest;
  sums[SUM_LARGEST_I] = largest > 0.0 ? (double)row_sphere[where] : 0.0;
  sums[SUM_LARGEST_J] = largest > 0.0 ? (double)(0xFFFFFFFFu - row_part[where]) : 0.0;
  sums[SUM_WALL_WORK] = work;
}

/* Columns of a span: the energies of its particles. */
KERNEL(fold_particles, step_numbers n, u32 spans, GLOBAL const chunk* RESTRICT chunks,
       GLOBAL const double* RESTRICT energy, GLOBAL double* RESTRICT out, GLOBAL const u32* RESTRICT flags) {
  const u32 span = ITEM;
  if (span >= spans || flags[FLAG_STOP]) return;
  CHUNK_OF_SPAN(first_particle_span)
  const u32 from = chunks[c].first_particle + (span - chunks[c].first_particle_span) * SPAN;
  const u32 to = MIN(chunks[c].last_particle, from + SPAN);
  for (u32 k = 0; k < PARTICLE_ENERGIES; ++k) {
    GLOBAL const double* column = energy + (u64)k * n.particles;
    double sum = 0.0;
    for (u32 p = from; p < to; ++p) sum += column[p];
    out[(u64)span * PARTICLE_ENERGIES + k] = sum;
  }
}

FN void add_span(GLOBAL double* sums, GLOBAL const double* span) {
  sums[SUM_ELASTIC] += span[SUM_ELASTIC];
  sums[SUM_FRICTION] += span[SUM_FRICTION];
  sums[SUM_DAMPING] += span[SUM_DAMPING];
  sums[SUM_PLASTIC] += span[SUM_PLASTIC];
  sums[SUM_TOUCHING] += span[SUM_TOUCHING];
  if (!(span[SUM_LARGEST] > sums[SUM_LARGEST])) return;
  sums[SUM_LARGEST] = span[SUM_LARGEST];
  sums[SUM_LARGEST_I] = span[SUM_LARGEST_I];
  sums[SUM_LARGEST_J] = span[SUM_LARGEST_J];
}

/* halves: energies of rotation stand for whole ones before and after the kick, of which half counts. */
KERNEL(fold_chunks, step_numbers n, u32 halves, u32 sphere_spans, u32 particle_spans,
       GLOBAL const chunk* RESTRICT chunks, GLOBAL const double* RESTRICT pairs, GLOBAL const double* RESTRICT walls,
       GLOBAL const double* RESTRICT particles, GLOBAL double* RESTRICT out, GLOBAL const u32* RESTRICT flags) {
  const u32 c = ITEM;
  if (c >= n.chunks || flags[FLAG_STOP]) return;
  const u32 width = SUMS + 6u * n.parts, last = c + 1 == n.chunks;
  GLOBAL double* sums = out + (u64)c * width;
  for (u32 k = 0; k < width; ++k) sums[k] = 0.0;
  const u32 end = last ? sphere_spans : chunks[c + 1].first_sphere_span;
  for (u32 s = chunks[c].first_sphere_span; s < end; ++s) add_span(sums, pairs + (u64)s * SUMS);
  for (u32 s = chunks[c].first_sphere_span; s < end; ++s) {
    GLOBAL const double* span = walls + (u64)s * width;
    add_span(sums, span);
    sums[SUM_WALL_WORK] += span[SUM_WALL_WORK];
    for (u32 k = SUMS; k < width; ++k) sums[k] += span[k];
  }
  const u32 particle_end = last ? particle_spans : chunks[c + 1].first_particle_span;
  if (n.forces)
    for (u32 s = chunks[c].first_particle_span; s < particle_end; ++s)
      sums[SUM_FORCE_WORK] += particles[(u64)s * PARTICLE_ENERGIES + 8u];
  if (!n.ledger) return;
  double px = 0.0, py = 0.0, pz = 0.0, before = 0.0, after = 0.0;
  for (u32 s = chunks[c].first_particle_span; s < particle_end; ++s) {
    GLOBAL const double* e = particles + (u64)s * PARTICLE_ENERGIES;
    sums[SUM_TRANSLATION] += e[0];
    sums[SUM_GRAVITY] -= e[2];
    if (halves)
      before += e[1];
    else
      sums[SUM_ROTATION] += e[1];
  }
  for (u32 s = chunks[c].first_particle_span; s < particle_end; ++s) {
    GLOBAL const double* e = particles + (u64)s * PARTICLE_ENERGIES;
    sums[SUM_TRANSLATION] += e[3];
    if (halves)
      after += e[4];
    else
      sums[SUM_ROTATION] += e[4];
    px += e[5];
    py += e[6];
    pz += e[7];
  }
  if (halves) sums[SUM_ROTATION] += 0.5 * (before + after);
  sums[SUM_GRAVITY_WORK] += (n.gravity_x * px + n.gravity_y * py + n.gravity_z * pz) * n.dt;
}

/* Of the first half of verlet: the work of gravity of each chunk. */
KERNEL(fold_drift, step_numbers n, u32 particle_spans, GLOBAL const chunk* RESTRICT chunks,
       GLOBAL const double* RESTRICT particles, GLOBAL double* RESTRICT out, GLOBAL const u32* RESTRICT flags) {
  const u32 c = ITEM;
  if (c >= n.chunks || flags[FLAG_STOP]) return;
  const u32 end = c + 1 == n.chunks ? particle_spans : chunks[c + 1].first_particle_span;
  double work = 0.0;
  for (u32 s = chunks[c].first_particle_span; s < end; ++s) work += particles[(u64)s * PARTICLE_ENERGIES];
  out[(u64)c * (SUMS + 6u * n.parts)] = work;
}

/* Totals: the sums of a step over all chunks, where friction, damping, plastic and all work go on adding up; then the
 * loads; then these. */
#define TOTAL_LARGEST(n) (SUMS + 6u * (n).parts)      /* overlap of all steps, share of the radius */
#define TOTAL_WRAPPED(n) (SUMS + 6u * (n).parts + 1u) /* J that periodic faces took from gravity; see EngineEnergy */

/* One item for each sum and load: chunks in order. */
KERNEL(close_sums, step_numbers n, GLOBAL const double* RESTRICT chunk_sums, GLOBAL double* RESTRICT totals,
       GLOBAL u32* RESTRICT flags) {
  const u32 k = ITEM, width = SUMS + 6u * n.parts;
  if (k >= width || flags[FLAG_STOP]) return;
  if (k == SUM_LARGEST_I || k == SUM_LARGEST_J) return;
  if (k == SUM_LARGEST) {
    double worst = 0.0;
    u32 where = n.chunks;
    for (u32 c = 0; c < n.chunks; ++c) {
      const double value = chunk_sums[(u64)c * width + k];
      if (!(value > worst)) continue;
      worst = value;
      where = c;
    }
    totals[SUM_LARGEST] = worst;
    totals[SUM_LARGEST_I] = where < n.chunks ? chunk_sums[(u64)where * width + SUM_LARGEST_I] : 0.0;
    totals[SUM_LARGEST_J] = where < n.chunks ? chunk_sums[(u64)where * width + SUM_LARGEST_J] : 0.0;
    if (worst > totals[TOTAL_LARGEST(n)]) totals[TOTAL_LARGEST(n)] = worst;
    if (worst > n.overlap_limit) ATOMIC_OR(flags + FLAG_OVERLAP, 1u);
    return;
  }
  const u32 goes_on = k == SUM_FRICTION || k == SUM_DAMPING || k == SUM_PLASTIC || k == SUM_WALL_WORK ||
                      k == SUM_GRAVITY_WORK || k == SUM_FORCE_WORK;
  double sum = goes_on ? totals[k] : 0.0;
  for (u32 c = 0; c < n.chunks; ++c) sum += chunk_sums[(u64)c * width + k];
  totals[k] = k == SUM_GRAVITY ? sum + totals[TOTAL_WRAPPED(n)] : sum;
}

/* One item: the end of a step. */
KERNEL(close_step, GLOBAL u32* RESTRICT flags) {
  if (ITEM > 0 || flags[FLAG_STOP]) return;
  flags[FLAG_DONE] += 1u;
  flags[FLAG_DRIFTED] = 0u;
  flags[FLAG_STOP] = flags[FLAG_STALE] | flags[FLAG_GUARD] | flags[FLAG_MISSING_LAW] | flags[FLAG_OVERLAP];
}

/* One item: the end of the first half of a step of verlet. */
KERNEL(close_drift, step_numbers n, GLOBAL const double* RESTRICT chunk_sums, GLOBAL double* RESTRICT totals,
       GLOBAL u32* RESTRICT flags) {
  if (ITEM > 0 || flags[FLAG_STOP]) return;
  double work = totals[SUM_GRAVITY_WORK];
  for (u32 c = 0; c < n.chunks; ++c) work += chunk_sums[(u64)c * (SUMS + 6u * n.parts)];
  totals[SUM_GRAVITY_WORK] = work;
  flags[FLAG_DRIFTED] = 1u;
  flags[FLAG_STOP] = flags[FLAG_STALE];
}

#endif
