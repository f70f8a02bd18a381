from lcpstep.kernels.record cimport COLUMNS, Record
from lcpstep.pointers cimport abs, after, max, min, nan, whole
from lcpstep.stepping.pieces.codes cimport CLOSED, RELEASE
from lcpstep.stepping.pieces.state cimport Work

cdef double UNSURE

cdef double late(
    double one, double first, double second, double length, double opened, double end
) noexcept nogil
cdef double hidden(double p, double q) noexcept nogil
cdef void loads(
    Work w, Record record, Py_ssize_t first, double* W, double* force, double* impulse
) noexcept nogil
