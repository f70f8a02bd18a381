cimport cython
from lcpstep.arrays cimport doubles
from lcpstep.kernels.dynamics cimport external_force, obstacle
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.vectors cimport copy
from lcpstep.maps.answers cimport Answers
from lcpstep.pointers cimport max, min
from lcpstep.stepping.theta_method.plan cimport Plan

cdef double OPEN, STRUCK


@cython.final
cdef class Lanes:
    cdef readonly dict arrays
    cdef object space, marks
    cdef Py_ssize_t n
    cdef double h, theta, A_f, A_q, A_v, A_g, W
    cdef double* q
    cdef double* v
    cdef double* g
    cdef double* u
    cdef double* p
    cdef double* before
    cdef double* slack
    cdef double* nobody
    cdef double* force
    cdef double* closed
    cpdef void take(self, Plan plan)


cpdef object advance(Model m, Lanes lanes, Answers a, double t0, double side, Py_ssize_t first, Py_ssize_t begin, Py_ssize_t last, Py_ssize_t k)
cdef void strike(Model m, Lanes lanes, double f, double f_next) noexcept nogil
cdef void take_step(Model m, Lanes lanes, double f, double f_next) noexcept nogil
cdef void note_impacts(Lanes lanes, Answers a, double t, Py_ssize_t k) noexcept nogil
cdef void mark_closed(Lanes lanes) noexcept nogil
