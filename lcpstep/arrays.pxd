cimport numpy as cnp


cdef inline bint are_doubles(object x, int dimensions) noexcept:
    return (
        type(x) is cnp.ndarray
        and cnp.PyArray_TYPE(<cnp.ndarray> x) == cnp.NPY_DOUBLE
        and cnp.PyArray_NDIM(<cnp.ndarray> x) == dimensions
        and cnp.PyArray_ISCARRAY(<cnp.ndarray> x)
    )


cdef inline double* doubles(object x) noexcept:
    return <double*> cnp.PyArray_DATA(<cnp.ndarray> x)


cdef inline Py_ssize_t* indices(object x) noexcept:
    return <Py_ssize_t*> cnp.PyArray_DATA(<cnp.ndarray> x)


cdef inline unsigned char* small_numbers(object x) noexcept:
    return <unsigned char*> cnp.PyArray_DATA(<cnp.ndarray> x)
