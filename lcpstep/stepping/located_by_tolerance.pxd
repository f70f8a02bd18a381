from lcpstep.stepping.located_parts cimport Parts

cdef class Attempts(Parts):
