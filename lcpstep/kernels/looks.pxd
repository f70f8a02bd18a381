cimport cython
from lcpstep.kernels.model cimport Model

@cython.locals(found=bint, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, before=Py_ssize_t)
cdef bint find_inside(
    Model m, Py_ssize_t count, double* t, double* q, Py_ssize_t looks, double share, bint towards, double* work
) noexcept
cdef void gaps_at(Model m, double t, double* q, double* v, double* x, double* g) noexcept nogil
cdef Py_ssize_t place(Py_ssize_t i, Py_ssize_t looks, Py_ssize_t count) noexcept nogil
@cython.locals(i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, side=Py_ssize_t)
cdef double find_highest(
    Model m, Py_ssize_t count, double* t, double* q, double* v, Py_ssize_t looks, double near, double* work
) noexcept
cpdef (double, double) at_most(Model m) noexcept
cdef double largest_row(double* A, Py_ssize_t n) noexcept nogil
cdef bint four_at_once(double* x, Py_ssize_t n) noexcept
@cython.locals(
    found=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, k=Py_ssize_t, c=Py_ssize_t, i_p=Py_ssize_t
)
cdef Py_ssize_t find_turn(
    Model m, Py_ssize_t count, double* t, double* q, double* v, Py_ssize_t steps, Py_ssize_t looks, double golden,
    double* places, Py_ssize_t n_places, double* limits, double* work
) noexcept
cdef double spread(Py_ssize_t i, Py_ssize_t looks, double golden) noexcept nogil
cdef void ahead(
    Model m, double t, double first, double last, double* q, double* v, double length, double* x, double* g
) noexcept nogil
