/* Which loops of lanes.py the compiler makes twice: for every x86-64 processor, for those with AVX2; see rows.h. */
#if defined(__GNUC__) && defined(__x86_64__)
#include <stddef.h>
#define CLONED static __attribute__((target_clones("default", "avx2")))
CLONED void lcpstep_find_free(double *, double *, double *, double, double, double, ptrdiff_t);
CLONED void lcpstep_find_impulses(
    double *, double *, double *, double *, double *, double, double, double, double, double, ptrdiff_t
);
CLONED void lcpstep_move(double *, double *, double *, double *, double, double, double, ptrdiff_t);
CLONED void lcpstep_measure(double *, double *, double *, double *, double, double, double, ptrdiff_t);
CLONED void lcpstep_count_closed(double *, double *, ptrdiff_t);
#endif
