cimport numpy as cnp


cdef inline double* doubles(object x) noexcept:
    return <double*> cnp.PyArray_DATA(<cnp.ndarray> x)


cdef inline Py_ssize_t* indices(object x) noexcept:
    return <Py_ssize_t*> cnp.PyArray_DATA(<cnp.ndarray> x)
