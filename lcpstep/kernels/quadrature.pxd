cdef double[4] NODES_4, WEIGHTS_4
cdef double[8] NODES_8, WEIGHTS_8
