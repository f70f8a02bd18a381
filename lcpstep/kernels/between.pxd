cimport cython

cpdef last_rows(object t, object times, Py_ssize_t least, Py_ssize_t most)
@cython.locals(n=Py_ssize_t)
cpdef on_lines(object t, object q, object v, object times, object rows)
@cython.locals(n=Py_ssize_t, bent=bint, at_end=bint)
cpdef on_parabolas(object t, object q, object v, object jumps, object times, object rows)
@cython.locals(n=Py_ssize_t, known=bint)
cpdef accelerated(object t, object q, object v, object a, object times, object rows)
@cython.locals(n=Py_ssize_t, terms=Py_ssize_t)
cpdef by_dense_output(object t, object q, object v, object length, object F, object times, object rows)
