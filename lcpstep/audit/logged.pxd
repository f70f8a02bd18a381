cimport cython
from lcpstep.arrays cimport doubles, small_numbers
from lcpstep.pointers cimport whole

cdef double IMPACT

@cython.locals(k=Py_ssize_t, j=Py_ssize_t, last=Py_ssize_t, n=Py_ssize_t, n_c=Py_ssize_t, n_events=Py_ssize_t)
cpdef object mark(object t, object time, object contact, object kind, object touched, object between)
