cimport cython
from lcpstep.stepping.rubbing.strides cimport Strides

cdef Py_ssize_t DONE, NOT_FINITE, PAINLEVE_INCONSISTENT, STEP_TOO_SMALL
cdef double ROUNDING, SAFETY, LEAST, MOST, LEAST_SHARE, STEEP, NEAR

@cython.locals(truncated=bint, steep=bint, longer=double, error=double, share=double, allowed=double)
cdef Py_ssize_t pace(Strides s, double t, double longest) noexcept nogil
cdef bint leaps(Strides s, double h) noexcept nogil
cdef Py_ssize_t why(Strides s, double error) noexcept nogil
cdef double change(Strides s, double allowed, double error) noexcept nogil
@cython.locals(good=bint)
cdef bint halves(Strides s, double t, double h) noexcept nogil
@cython.locals(least=double, off=double, error=double)
cdef double weigh(Strides s, double h) noexcept nogil
cdef double strayed(Strides s, Py_ssize_t g) noexcept nogil
cdef double value_at(Strides s, double x) noexcept nogil
