cdef class Course(Events):
    cdef Arc s
