cimport cython
from lcpstep.events.hybrid.field cimport Machine
from lcpstep.events.hybrid.loop cimport Switching
from lcpstep.events.hybrid.state cimport Motion
from lcpstep.maps.saltation.switches cimport Tangent
from lcpstep.kernels.function cimport Functions
from lcpstep.pointers cimport Doubles, Indices

cdef Py_ssize_t ARRIVE, NOT_SLIDING, SWITCH_LEAD, BUFFER_FULL, DONE, NOT_FINITE, UNREACHED, UNKNOWN, NO_LIMIT
cdef double ON_SURFACE


@cython.final
cdef class Placing:
    cdef Machine m
    cdef Functions mode_of
    cdef object out_array, called
    cdef bint asked
    cdef Py_ssize_t sliding
    cdef Doubles out
    cdef Py_ssize_t place(self, double t, double* x) noexcept nogil


@cython.final
cdef class Follow:
    cdef object kept_arrays, numbers
    cdef readonly Motion s
    cdef Switching course
    cdef readonly Tangent tangent
    cdef Placing placing
    cdef bint under_way, tangents_wanted
    cdef readonly Py_ssize_t runs, run, taken, period
    cdef Py_ssize_t n, mode, drop, periods, n_targets, kept, most
    cdef readonly double t_start, t_end
    cdef Doubles x, rate, g_x, starts, targets, radius, scale, states, tangents, impacts, landings, final
    cdef Indices counts, reached, run_taken, codes


cpdef Py_ssize_t follow(Follow f, Py_ssize_t until)
cdef Py_ssize_t go_through(Follow f, Py_ssize_t until) noexcept nogil
cdef void end_run(Follow f, Py_ssize_t code) noexcept nogil
cdef Py_ssize_t one_period(Follow f) noexcept nogil
cdef Py_ssize_t near(Follow f, double* x) noexcept nogil
cdef Py_ssize_t note(Follow f, Py_ssize_t k) noexcept nogil
cdef void note_switch(Follow f, double* line, double* out) noexcept nogil
