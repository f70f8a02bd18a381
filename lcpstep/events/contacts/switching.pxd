cdef class Watched(Motion):
    cdef Rubbing rubbing
