cdef enum: FINISHED = 0, NOT_FINITE = 2, LCP_FAILED = 3, TOO_MANY_EVENTS = 5
cdef enum: BUFFER_FULL = -1, STOPPED = -2, AGAIN = -3
cdef enum: IMPACT = 0, ACCUMULATION = 1, STICK = 2, RELEASE = 3
cdef enum: OPEN = 0, CLOSED = 1
cdef enum: GROUND = 1, LEFT = 2
cdef enum: NOBODY = -1, CORNER = -2
cdef enum: WHOLE = 0, REST = 1, INERTIA = 2

cdef extern from *:
    double SAME_TIME "0x1p-49"
    double LATE "1e-9"
    double STOPS "1e-9"
