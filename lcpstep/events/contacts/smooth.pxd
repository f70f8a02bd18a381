cdef class Smooth(Rubbing):
