cimport cython
from lcpstep.pointers cimport Doubles

cdef double RESOLUTION, ROUNDING
cdef Py_ssize_t LEAF, DEPTH, FIRST


@cython.final
cdef class Graph:
    cdef object kept
    cdef Py_ssize_t n, leaves
    cdef readonly double size
    cdef Doubles x, y, boxes


cdef double farthest(
    Graph a, Graph b, double bound, double rounding, Py_ssize_t* nodes, double* pieces
) noexcept nogil
cdef bint covered(
    double x0, double y0, double x1, double y1, Graph b, Py_ssize_t segment, double bound
) noexcept nogil
cdef Py_ssize_t nearest(
    Graph g, double x, double y, double enough, Py_ssize_t guess, Py_ssize_t* nodes
) noexcept nogil
cdef double to_box(Graph g, Py_ssize_t node, double x, double y) noexcept nogil
cdef double to_segment(Graph g, Py_ssize_t s, double x, double y) noexcept nogil
