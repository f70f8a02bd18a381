cdef class Course(Events):
    cdef Flight s
