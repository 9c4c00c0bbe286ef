/* leaning_text.law.h: a linear spring whose text leans on a macro that only leaning_text.c defines: it compiles there, and
 * nowhere else. */
#define leaning_text_pair_LIST(X) X(k, "N/m", 0, 1e9, 100, 0, "normal stiffness")
#define leaning_text_prop_LIST(X)
#define leaning_text_state_LIST(X)
#define leaning_text_NEEDS (CALX_NEED_OVERLAP | CALX_NEED_NORMAL)

CALX_LAW_DECLARE(leaning_text)

CALX_LAW_EVAL(leaning_text) {
  const real fn = p->k * c->overlap * LEANING_TEXT_STIFFER;
  out->fx = fn * c->nx;
  out->fy = fn * c->ny;
  out->fz = fn * c->nz;
}
