/* Which loops of rows.py the compiler makes twice: for every x86-64 processor, for those with AVX2. The choice is
   made when the library is loaded, which GNU's C library can. Included before the C that Cython writes. */
#if defined(__GNUC__) && defined(__x86_64__)
#include <stddef.h>
#define CLONED static __attribute__((target_clones("default", "avx2")))
CLONED double lcpstep_dot(double *, double *, ptrdiff_t);
CLONED double lcpstep_dot_sizes(double *, double *, ptrdiff_t);
CLONED void lcpstep_subtract(double *, double *, double, ptrdiff_t);
CLONED void lcpstep_add_four(double *, double *, ptrdiff_t, double *, ptrdiff_t, ptrdiff_t);
CLONED void lcpstep_ratios(double *, double *, double, double *, double, ptrdiff_t);
CLONED void lcpstep_excesses(double *, double *, double, double *, double, ptrdiff_t);
CLONED void lcpstep_turn_four(double *, double *, double *, double *, ptrdiff_t, ptrdiff_t);
CLONED void lcpstep_multiply(double *, double, ptrdiff_t);
CLONED void lcpstep_raise_to(double *, double *, double, ptrdiff_t);
CLONED long long lcpstep_largest_magnitude(double *, ptrdiff_t);
CLONED double lcpstep_largest_entry(double *, ptrdiff_t);
CLONED double lcpstep_lowest_entry(double *, ptrdiff_t);
#endif
