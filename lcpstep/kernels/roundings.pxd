cdef extern from *:
    double RESOLUTION "0x1p-52"
    double NOISE "0x1p-46"
    double MARGIN "0x1p-49"
