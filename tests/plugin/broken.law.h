/* broken.law.h: a law that breaks the dialect on purpose, once on each line marked so. */
#define broken_pair_LIST(X) X(kn, "N/m", 0, 1e9, 1e4, 0, "normal stiffness")
#define broken_prop_LIST(X)
#define broken_state_LIST(X) X(memory, "m", 0, 1, 0, 0, "largest overlap")
#define broken_NEEDS (CALX_NEED_OVERLAP | CALX_NEED_NORMAL)
#include <math.h>        /* BROKEN: only #define */
#define other_helper(x) (x) /* BROKEN: foreign name */

CALX_LAW_DECLARE(broken)

CALX_LAW_EVAL(broken) {
  const real half = 0.5;                              /* BROKEN: bare literal */
  const real good = R(0.5) * half;
  double wide = good;                                 /* BROKEN: another type */
  const real cast = (real)wide;                       /* BROKEN: cast */
  const real root = sqrt(c->overlap);                 /* BROKEN: the library's own root */
  if (c->overlap > cast) s->memory = c->overlap;      /* BROKEN: if */
  for (; s->memory > root;) s->memory = root;         /* BROKEN: loop */
  const real my__name = root;                         /* BROKEN: two underscores */
  const real third = (&s->memory)[0];                 /* BROKEN: index */
  out->fx = p->kn * my__name * third;                 /* BROKEN: two underscores */
}
