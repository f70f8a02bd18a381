cimport cython
from lcpstep.kernels.coulomb cimport ContactProblem

cdef Py_ssize_t MOST
cdef double CLEARLY

@cython.locals(i=Py_ssize_t, pressed=Py_ssize_t)
cdef Py_ssize_t opened_or_closed(ContactProblem c, Py_ssize_t n) noexcept nogil
cdef bint parts(ContactProblem c, Py_ssize_t n, Py_ssize_t i) noexcept nogil
@cython.locals(a=Py_ssize_t, smooth=bint)
cdef bint is_smooth(ContactProblem c, Py_ssize_t n) noexcept nogil
@cython.locals(i=Py_ssize_t, j=Py_ssize_t)
cdef bint is_sure(ContactProblem c, Py_ssize_t n) noexcept nogil
@cython.locals(i=Py_ssize_t, j=Py_ssize_t, carries=Py_ssize_t, most=double, alpha=double, size=double)
cdef bint answers(ContactProblem c, Py_ssize_t n, Py_ssize_t pressed) noexcept nogil
