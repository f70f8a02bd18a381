from lcpstep.kernels.record cimport Record


cdef inline void keep_one(Record record, double t, double length, double q, double v, double* impulse) noexcept nogil:
    cdef Py_ssize_t k = record.row
    record.t[k], record.q[k], record.v[k] = t, q, v
    if length != 0.0:
        record.length[k] = length
    if impulse[0] != 0.0:
        record.impulse[k], impulse[0] = impulse[0], 0.0
    record.row = k + 1
