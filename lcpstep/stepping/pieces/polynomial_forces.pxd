cimport cython
from lcpstep.kernels.dynamics cimport gap_rates
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.vectors cimport product
from lcpstep.stepping.pieces.codes cimport CLOSED, GROUND, LEFT, OPEN, WHOLE
from lcpstep.stepping.pieces.contact_forces cimport hold
from lcpstep.stepping.pieces.keep cimport keep
from lcpstep.stepping.pieces.polynomial cimport Polynomial, acceleration, biases
from lcpstep.stepping.pieces.scan cimport SOON
from lcpstep.stepping.pieces.smooth cimport free_acceleration, respond
from lcpstep.stepping.pieces.state cimport Plan, Work
from lcpstep.stepping.pieces.times cimport within

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
