# Declared here and not cimported from numpy, which would bring all of its types into each module: two fifths of the
# time of translating them
cdef extern from "numpy/ndarrayobject.h":
    ctypedef class numpy.ndarray [object PyArrayObject, check_size ignore]:
        pass
    int NPY_DOUBLE
    void* PyArray_DATA(ndarray x) noexcept nogil
    int PyArray_TYPE(ndarray x) noexcept nogil
    int PyArray_NDIM(ndarray x) noexcept nogil
    bint PyArray_ISCARRAY(ndarray x) noexcept nogil


cdef inline bint are_doubles(object x, int dimensions) noexcept:
    return (
        type(x) is ndarray
        and PyArray_TYPE(<ndarray> x) == NPY_DOUBLE
        and PyArray_NDIM(<ndarray> x) == dimensions
        and PyArray_ISCARRAY(<ndarray> x)
    )


cdef inline double* doubles(object x) noexcept:
    return <double*> PyArray_DATA(<ndarray> x)


cdef inline Py_ssize_t* indices(object x) noexcept:
    return <Py_ssize_t*> PyArray_DATA(<ndarray> x)


cdef inline unsigned char* small_numbers(object x) noexcept:
    return <unsigned char*> PyArray_DATA(<ndarray> x)
