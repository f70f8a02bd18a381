cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef double SHORT, AS_SLOW, FINE
cdef Py_ssize_t IN_A_ROW, MANY_AT_ONCE

@cython.locals(x=double, fine=double)
cdef void measure_rates(Work w) noexcept nogil
cdef bint at_this_instant(Plan plan, Work w, Py_ssize_t c) noexcept nogil
cdef Py_ssize_t choose_connected(Work w, Py_ssize_t n_s) noexcept nogil
@cython.locals(row=bint, slow=bint)
cdef Py_ssize_t choose_collapsing(Plan plan, Work w, Py_ssize_t first, Py_ssize_t n_s) noexcept nogil
cdef void note_hit(Plan plan, Work w, Py_ssize_t c) noexcept nogil
@cython.locals(ends_in_time=bint)
cdef bint closes(Model m, Plan plan, Work w, Py_ssize_t c, bint alone, double t) noexcept nogil
cdef bint unresolved(Plan plan, Work w, Py_ssize_t c, double hop, double t) noexcept nogil
