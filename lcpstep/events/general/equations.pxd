from lcpstep.events.general.state cimport Mechanism, Rows
from lcpstep.kernels.model cimport Model

cdef double JUMPS, BENDS

cdef bint measure(Mechanism s, double t) noexcept nogil
cdef bint measure_on(Mechanism s, double t) noexcept nogil
cdef bint measure_again(Mechanism s, double t) noexcept nogil
cdef void constraint_rows(Mechanism s, double t, double* q, double* v) noexcept nogil
cdef void rates_on_side(Mechanism s, Model model, Rows now, double t, double* q, double* v) noexcept nogil
cdef void biases(Mechanism s, Model model, Rows now, double t, double* q, double* v) noexcept nogil
cdef double bias_of(Mechanism s, Py_ssize_t i) noexcept nogil
