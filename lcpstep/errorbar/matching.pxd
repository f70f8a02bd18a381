cimport cython

from lcpstep.pointers cimport Doubles, Indices

cdef Py_ssize_t IMPACT, ACCUMULATION
cdef Py_ssize_t START, STOP, LATE_BY, IMPULSE, JUMP, OF_PAIR
cdef double ALIKE, NEAR


@cython.final
cdef class Log:
    cdef readonly object times, impulses, jumps, contacts, kinds
    cdef readonly Py_ssize_t n
    cdef readonly double end
    cdef Doubles time, impulse, jump
    cdef Indices contact, kind
    cdef bint strikes(self, Py_ssize_t k) noexcept nogil

@cython.locals(most=Py_ssize_t)
cdef Py_ssize_t most_contacts(Log a) noexcept nogil
@cython.locals(largest=double)
cdef double largest_jump(Log a) noexcept nogil
@cython.locals(found=bint)
cdef bint has_chattering(Log a) noexcept nogil
@cython.locals(n=Py_ssize_t, c=Py_ssize_t, strikes=Py_ssize_t)
cdef Py_ssize_t find_pairs(
    Log a, Log b, Py_ssize_t most, Py_ssize_t* rows, Py_ssize_t* good, Py_ssize_t* work, double* late
) noexcept
cdef void mark(
    Log a, Log b, Py_ssize_t n, Py_ssize_t* rows, Py_ssize_t* good, double late, double weak, double resolution
) noexcept
cdef bint is_pair(
    Log a, Log b, Py_ssize_t n, Py_ssize_t* rows, Py_ssize_t k, double late, double weak, double resolution
) noexcept nogil
@cython.locals(count=Py_ssize_t)
cdef Py_ssize_t write_pairs(
    Log a, Log b, Py_ssize_t n, Py_ssize_t* rows, Py_ssize_t* good, double* numbers, Py_ssize_t* own
) noexcept
