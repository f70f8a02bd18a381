cdef class Sudden:
    cdef bint narrow
    cdef double h, low, high, before, later, middle, whole, x, drift
