cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.polynomial cimport Polynomial
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef double UNDECIDED
@cython.locals(needed=bint, undecided=bint)
cdef bint load(
    Model m, Plan plan, Work w, Polynomial z, Record record, double t, double length
) noexcept nogil
cdef bint look_ahead(
    Model m, Plan plan, Work w, Polynomial z, Record record, double t, double ahead
) noexcept nogil
cdef bint decide(
    Model m, Plan plan, Work w, Record record, double at, double* q, double* v, double t
) noexcept nogil
