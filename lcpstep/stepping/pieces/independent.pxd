from lcpstep.stepping.pieces.state cimport Work

cdef void bear_on_independent(Work w, double* W, Py_ssize_t n) noexcept nogil
cdef (Py_ssize_t, Py_ssize_t) first_dependent(Work w, double* W, Py_ssize_t n) noexcept nogil
cdef void shift(Work w, double* W, Py_ssize_t n, Py_ssize_t k, Py_ssize_t n_k) noexcept nogil
