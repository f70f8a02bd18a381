cimport cython
from lcpstep.events.general.state cimport Mechanism
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t NO_IMPULSES, BUFFER_FULL, DONE

@cython.locals(solved=bint)
cdef Py_ssize_t pass_corner(Mechanism s, Record record, Tally tally) noexcept nogil
@cython.locals(some=bint, driven=bint, found=bint)
cdef bint throws(Mechanism s) noexcept nogil
