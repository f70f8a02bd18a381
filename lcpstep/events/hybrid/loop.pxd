cdef class Switching(Course):
    cdef Motion s
