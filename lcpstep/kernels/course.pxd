cdef class Course:

cdef class Stepwise(Course):
    cdef double t0
    cdef Py_ssize_t first, last

cdef class Events(Course):
    cdef Clock clock
    cdef Py_ssize_t room
