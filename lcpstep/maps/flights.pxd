cdef class Runs:
    cdef Flight s, aside
    cdef Course course
    cdef Answers answers
    cdef readonly Py_ssize_t taken
    cdef Py_ssize_t run, code, period, age, power, kicked, noisy
    cdef bint begun
    cdef double old_q, old_v, length, speed
