cdef double[8] NODE
cdef double[8] WEIGHT
