cdef class Course(Events):
    cdef Mechanism s
