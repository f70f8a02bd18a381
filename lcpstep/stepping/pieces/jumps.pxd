cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.stepping.pieces.loop cimport Steps
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef double BRIEF, SIDES

cdef bint breaks(Steps way, Work w, double t, double length) noexcept nogil
@cython.locals(coarse=double, beyond=bint)
cdef double hidden_by_rounding(Steps way, Work w, double t, Py_ssize_t i) noexcept nogil
cdef double place_of(Model m, Work w, double t, double coarse) noexcept nogil
@cython.locals(found=Py_ssize_t)
cdef Py_ssize_t farthest_off(Steps way, Work w, double t, double length) noexcept nogil
cdef void measure_rows(Steps way, Work w, double t, double tau) noexcept nogil
cdef double velocity(Work w, Py_ssize_t i) noexcept nogil
cdef double size_of(Plan plan, Work w, Py_ssize_t i) noexcept nogil
cdef bint lies_apart(Work w, double t, double margin) noexcept nogil
