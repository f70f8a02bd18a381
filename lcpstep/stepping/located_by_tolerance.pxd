
cdef class Attempts(Parts):
