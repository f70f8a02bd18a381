cdef extern from *:
    """
    #include <math.h>
    #include <string.h>
    static CYTHON_INLINE long long lcpstep_bits(double x) { long long k; memcpy(&k, &x, sizeof k); return k; }
    static CYTHON_INLINE double lcpstep_double_of(long long k) { double x; memcpy(&x, &k, sizeof x); return x; }
    """
    double abs "fabs"(double x) noexcept nogil
    double inf "((double)INFINITY)"
    double nan "((double)NAN)"
    long long bits "lcpstep_bits"(double x) noexcept nogil
    double double_of "lcpstep_double_of"(long long bits) noexcept nogil

# Named, so that several fields fit in one line
ctypedef double* Doubles
ctypedef Py_ssize_t* Indices
ctypedef unsigned char* Flags


cdef inline double max(double a, double b) noexcept nogil:
    return b if b > a else a


cdef inline double min(double a, double b) noexcept nogil:
    return b if b < a else a


cdef inline Doubles after(Doubles x, Py_ssize_t i) noexcept nogil:
    return x + i


cdef inline Indices indices_after(Indices x, Py_ssize_t i) noexcept nogil:
    return x + i


ctypedef void (*Callback)(double t, double* q, double* v, double* p, double* out, Py_ssize_t* sizes) noexcept nogil


cdef inline Callback callback_at(size_t address) noexcept nogil:
    return <Callback> address


cdef inline Py_ssize_t whole(double x) noexcept nogil:
    return <Py_ssize_t> x
