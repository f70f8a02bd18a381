cimport cython
from lcpstep.kernels.coulomb cimport ContactProblem

cdef Py_ssize_t PHASES, TURNS
cdef double LOCKED, LEFT, LIKE, ROUNDING

@cython.locals(fastest=double)
cdef bint strike_in_turn(
    ContactProblem c, double* restitution, Py_ssize_t n_a, Py_ssize_t n_f, Py_ssize_t jams
) noexcept nogil
cdef Py_ssize_t fastest_of(double* u, Py_ssize_t n_a, double slow) noexcept nogil
cdef bint strike_one(ContactProblem c, Py_ssize_t a, Py_ssize_t n_a, Py_ssize_t n_f, double e, bint jams) noexcept nogil
@cython.locals(compressed=bint, sticks=bint, ends=bint, step=double, length=double, share=double)
cdef bint integrate(
    double W_NN, double W_NT, double W_TN, double W_TT, double mu, double e, double u, double slip, bint jams,
    double* p,
) noexcept nogil
@cython.locals(done=bint)
cdef bint settle(ContactProblem c, Py_ssize_t n_a, Py_ssize_t n_f, double fastest) noexcept nogil
