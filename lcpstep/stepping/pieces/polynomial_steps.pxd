cdef class PolynomialSteps(Steps):
    cdef readonly Polynomial z
    cdef bint watched, opens
