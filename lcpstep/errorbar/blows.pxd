cimport cython

from lcpstep.errorbar.matching cimport Log

cdef Py_ssize_t START, STOP, LATE_BY, IMPULSE, JUMP, OF_PAIR
cdef Py_ssize_t FIRST, LAST, HARD, PUSH, OF_BLOW
cdef Py_ssize_t ANOTHER, OF_RUN, OF_COMPANION

@cython.locals(n=Py_ssize_t, count=Py_ssize_t, p=Py_ssize_t)
cdef Py_ssize_t join(
    Log log, Py_ssize_t contact, double resolution, double* blows, bint noted, Py_ssize_t* rows, Py_ssize_t* begins
) noexcept
cdef double room(Py_ssize_t n, double* blows, Py_ssize_t k, double resolution) noexcept nogil
@cython.locals(i=Py_ssize_t, j=Py_ssize_t, count=Py_ssize_t, left=Py_ssize_t, both=bint)
cdef Py_ssize_t pair_blows(
    Py_ssize_t n, double* a, Py_ssize_t m, double* b, double resolution, Py_ssize_t* pairs, Py_ssize_t* alone
) noexcept
@cython.locals(count=Py_ssize_t)
cdef Py_ssize_t write_matched(
    Py_ssize_t k, double* a, double* b, Py_ssize_t* pairs, double* numbers, Py_ssize_t* rows, Py_ssize_t* begins,
    Py_ssize_t* many
) noexcept
@cython.locals(n=Py_ssize_t, i=Py_ssize_t, own=bint)
cdef Py_ssize_t suspect(
    Py_ssize_t k, double* numbers, double* a, double* b, Py_ssize_t* pairs, Py_ssize_t left, Py_ssize_t* alone,
    double weak, double* doubts
) noexcept
