cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef double SAME_SPEED, SMALL

cdef Py_ssize_t strike(Model m, Plan plan, Work w, Record record, Py_ssize_t first, double t) noexcept nogil
cdef void touch(Work w, Py_ssize_t c) noexcept nogil
@cython.locals(collapsed=bint, together=Py_ssize_t)
cdef Py_ssize_t answer(
    Model m, Plan plan, Work w, Record record, Py_ssize_t first, double t, bint drifted
) noexcept nogil
@cython.locals(touched=bint, closing=bint, near=bint, met=bint, pushed=bint, alike=bint)
cdef Py_ssize_t choose_struck(Model m, Plan plan, Work w, Py_ssize_t first, double t) noexcept nogil
cdef double rounding_of_time(Work w, double t) noexcept nogil
cdef bint tied(Model m, Plan plan, Work w, Py_ssize_t d, Py_ssize_t c, double missed) noexcept nogil
cdef double rounding_of_gap(Model m, Plan plan, Work w, Py_ssize_t c) noexcept nogil
cdef double jump(Plan plan, Work w, Py_ssize_t n_s) noexcept nogil
cdef void zero_speeds(Work w, double* terms) noexcept nogil
@cython.locals(touches=bint)
cdef void push(Plan plan, Work w, Py_ssize_t d, double p) noexcept nogil
cdef void after_impact(
    Model m, Plan plan, Work w, Record record, Py_ssize_t c, double p, double t
) noexcept nogil
