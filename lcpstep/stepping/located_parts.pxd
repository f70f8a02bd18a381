cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.pointers cimport Doubles, Indices
from lcpstep.stepping.pieces.loop cimport Steps
from lcpstep.stepping.pieces.state cimport Plan, Work
from lcpstep.stepping.step_control cimport Control

cdef Py_ssize_t LEVELS, OWN


@cython.final
cdef class Led:
    cdef object kept
    cdef Py_ssize_t code
    cdef double time, off
    cdef Doubles q, v, gap, half, force, impulse
    cdef Indices status
    cdef bint good(self) noexcept nogil


cdef void copy_state(
    Work to, Work w, Py_ssize_t n_numbers, Py_ssize_t n_marks, Py_ssize_t n_matrices
) noexcept nogil


cdef class Parts(Control):
    cdef Steps way
    cdef Model m
    cdef Plan plan
    cdef Work w, saved
    cdef object own_row
    cdef Py_ssize_t n_numbers, n_marks, n_matrices
    cdef Doubles last_row, A_inverse, AG, WA
    cdef bint rough, means, alike, sized
    cdef Led one, half, two
    cdef double from_time, to_time, h, elapsed, stuck
    @cython.locals(even=bint)
    cdef void compare(self, double start, double end, bint entire, double until) noexcept nogil
    cdef double ends(self) noexcept nogil
    cdef Py_ssize_t part(
        self, double start, double end, double last, bint even, double until, int halved
    ) noexcept nogil
    cdef void place(self, int level, double made_for) noexcept nogil
    @cython.locals(just=bint)
    cdef void carry_on(self, double start, bint anew, double close) noexcept nogil
    cdef void led(self, Led to, Py_ssize_t code) noexcept nogil
    cdef void loads(self, double* force, double* impulse) noexcept nogil
