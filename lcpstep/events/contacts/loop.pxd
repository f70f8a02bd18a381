cdef class Course(Events):
    cdef Rubbing s
