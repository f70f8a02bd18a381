cdef enum: STOPPED = -2, AGAIN = -3
cdef enum: OPEN = 0, CLOSED = 1
cdef enum: GROUND = 1, LEFT = 2
cdef enum: NOBODY = -1, CORNER = -2
cdef enum: WHOLE = 0, REST = 1, INERTIA = 2

cdef extern from *:
    double SAME_TIME "0x1p-49"
    double STOPS "1e-9"
