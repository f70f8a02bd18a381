cdef class Shelf:
    cdef Doubles rest

cdef class IndexShelf:
    cdef Indices rest
