cimport cython
from lcpstep.events.rows.state cimport Rows

cdef double DEPENDENT, TAKEN_OUT, ROUNDED, PARTED, DISAGREEMENT
cdef Py_ssize_t REFINEMENTS

@cython.locals(found=bint)
cdef bint is_held(Rows s, Py_ssize_t i) noexcept nogil
cdef double entry(Rows s, Py_ssize_t i, Py_ssize_t k) noexcept nogil
cdef Py_ssize_t first_between(Rows s, Py_ssize_t i, Py_ssize_t k) noexcept nogil
@cython.locals(start=Py_ssize_t)
cdef bint hold(Rows s, Py_ssize_t i) noexcept nogil
cdef double grow(Rows s, Py_ssize_t i, Py_ssize_t m, Py_ssize_t start) noexcept nogil
cdef (double, double) what_is_left(Rows s, Py_ssize_t i, Py_ssize_t k, Py_ssize_t first) noexcept nogil
cdef void hold_joints(Rows s) noexcept nogil
@cython.locals(dependent=Py_ssize_t)
cdef Py_ssize_t hold_again(Rows s) noexcept nogil
cdef bint renew_held(Rows s, double t, double* q, double* v) noexcept nogil
cdef void solve_held(Rows s, double* x) noexcept nogil
cdef void add_column(Rows s, double* R, Py_ssize_t i, double x, double* a) noexcept nogil
cdef void push_by_change(Rows s, double* x) noexcept nogil
cdef void constrain(Rows s, double* a, double* bias) noexcept nogil
cdef void measure_missing(Rows s, double* a, double* bias) noexcept nogil
cdef void balance(Rows s, double* a) noexcept nogil
cdef double size_of_pushes(Rows s) noexcept nogil
cdef Py_ssize_t contradiction(Rows s, double* a) noexcept nogil
cdef Py_ssize_t parted(Rows s, double* gap, double* q) noexcept nogil
