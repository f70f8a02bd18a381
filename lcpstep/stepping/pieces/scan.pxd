cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.stepping.pieces.polynomial cimport Polynomial
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef Py_ssize_t NOWHERE, PARTS
cdef double BRIEF, FALLS, LOW, SOON
cdef (double, double) gap_at(
    Model m, Plan plan, Work w, Polynomial z, double t, double tau, Py_ssize_t c
) noexcept nogil
cdef (double, double) hop_at(
    Model m, Plan plan, Work w, Polynomial z, double t, double tau, Py_ssize_t c
) noexcept nogil
cdef bint is_low(Plan plan, Work w, double tau, Py_ssize_t c) noexcept nogil
cdef double height_terms(Model m, Work w, Polynomial z, Py_ssize_t c) noexcept nogil
cdef double landing(
    Model m, Plan plan, Work w, Polynomial z, double t, double a, double b, Py_ssize_t c, bint low
) noexcept nogil
cdef double lowest(
    Model m, Plan plan, Work w, Polynomial z, double t, double a, double b, Py_ssize_t c
) noexcept nogil
@cython.locals(hop=bint, fine=bint, rests=bint, touches=bint)
cdef (Py_ssize_t, double) first_landing(
    Model m, Plan plan, Work w, Polynomial z, double t, double end
) noexcept nogil
cdef (Py_ssize_t, double) first_release(
    Model m, Plan plan, Work w, Polynomial z, double t, double end
) noexcept nogil
cdef (Py_ssize_t, double) release_at(
    Model m, Plan plan, Work w, Polynomial z, double t, double end, Py_ssize_t probe
) noexcept nogil
@cython.locals(most=double, x=double, before=Py_ssize_t)
cdef (Py_ssize_t, double) brief_release(
    Model m, Plan plan, Work w, Polynomial z, double t, double end, Py_ssize_t probe, Py_ssize_t last
) noexcept nogil
cdef double from_probe(Work w, double end, Py_ssize_t probe) noexcept nogil
cdef double vanishing(
    Model m, Plan plan, Work w, Polynomial z, double t, double a, double b, double f_b, Py_ssize_t c
) noexcept nogil
