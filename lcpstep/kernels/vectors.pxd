cdef inline void copy(double* x, double* y, Py_ssize_t n) noexcept nogil:
    for i in range(n):
        x[i] = y[i]


cdef inline void clear(double* x, Py_ssize_t n) noexcept nogil:
    for i in range(n):
        x[i] = 0.0


cdef inline void add(double* x, double factor, double* y, Py_ssize_t n) noexcept nogil:
    for i in range(n):
        x[i] += factor * y[i]


cdef inline double product(double* G, double* v, Py_ssize_t c, Py_ssize_t n) noexcept nogil:
    cdef double total = 0.0
    for j in range(n):
        total += G[c * n + j] * v[j]
    return total


cdef inline double size_of_product(double* G, double* v, Py_ssize_t c, Py_ssize_t n) noexcept nogil:
    cdef double size = 0.0
    for j in range(n):
        size += abs(G[c * n + j] * v[j])
    return size


cdef inline double largest(double* x, double least, Py_ssize_t n) noexcept nogil:
    for i in range(n):
        if x[i] > least:
            least = x[i]
        elif -x[i] > least:
            least = -x[i]
    return least


cdef inline bint finite(double* x, Py_ssize_t n) noexcept nogil:
    cdef double total = 0.0
    for i in range(n):
        total += x[i] - x[i]
    return total == 0.0


cdef inline double distance(double* x, double* y, Py_ssize_t n) noexcept nogil:
    cdef double most = 0.0
    for i in range(n):
        if x[i] - y[i] > most:
            most = x[i] - y[i]
        elif y[i] - x[i] > most:
            most = y[i] - x[i]
    return most


cdef inline void copy_indices(Py_ssize_t* x, Py_ssize_t* y, Py_ssize_t n) noexcept nogil:
    for i in range(n):
        x[i] = y[i]
