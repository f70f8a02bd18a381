from lcpstep.kernels.course cimport Stepwise
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.theta_method.moving cimport Plan, Rows, State

cdef Py_ssize_t FINISHED, BUFFER_FULL, NOT_FINITE
cdef double LATE


cdef class Steps(Stepwise):
    cdef public Plan plan
    cdef readonly Model m
    cdef readonly State s
    cdef readonly Rows rows
    cdef readonly Record record
    cdef bint external, solved, single
    cpdef begin(self, double t, double side)
    cpdef Py_ssize_t run(self, double t0, Py_ssize_t first, Py_ssize_t last, bint solved)
    cdef Py_ssize_t stage(self, Py_ssize_t goal) noexcept nogil
    cdef Py_ssize_t move(self) noexcept nogil


cdef void look(Model m, State s, Rows c, double t) noexcept nogil
cdef Py_ssize_t end_step(
    Model m, Plan plan, State s, Rows c, Record record, double t, double t_next, Py_ssize_t events
) noexcept nogil
cdef void measure(Model m, State s, Rows c, double t) noexcept nogil
cdef void keep_times(double h, State s, Record record, double t, double t_next) noexcept nogil
