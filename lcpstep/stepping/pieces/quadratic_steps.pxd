cdef class QuadraticSteps(Steps):
