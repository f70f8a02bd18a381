cimport cython
from lcpstep.events.rows.state cimport Rows
from lcpstep.kernels.model cimport Model

cdef double JUMPS, BENDS

cdef bint free_motion(Rows s, double t, double* q, double* v, double* a) noexcept nogil
cdef void renew_rates(Rows s, double t, double* q, double* v) noexcept nogil
cdef void renew_biases(Rows s, double t, double* q, double* v) noexcept nogil
cdef void measure_rates(Rows s, double t, double* q, double* v) noexcept nogil
cdef void rates_on_side(Rows s, Model model, Py_ssize_t first, double t, double* q, double* v) noexcept nogil
cdef void measure_biases(Rows s, double t, double* q, double* v) noexcept nogil
cdef void biases_of(Rows s, Model model, Py_ssize_t first, double t, double* q, double* v) noexcept nogil
cdef void list_gaps(Rows s, double t, double* q, double* v) noexcept nogil
cdef void respond(Rows s) noexcept nogil
cdef void respond_held(Rows s) noexcept nogil
cdef void couple(Rows s, Py_ssize_t i, Py_ssize_t j) noexcept nogil
cdef Py_ssize_t other(Rows s, Py_ssize_t i) noexcept nogil
cdef void respond_to(Rows s, Py_ssize_t i) noexcept nogil
cdef double size_of(Rows s, Py_ssize_t i, double constant, double* x) noexcept nogil
cdef double size_of_acceleration(Rows s, Py_ssize_t i, double* a) noexcept nogil
cdef double least_effect(Rows s, Py_ssize_t i, double* x) noexcept nogil
