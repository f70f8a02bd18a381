cdef long long MAGNITUDE

# Named in C, for rows.h
cdef double dot "lcpstep_dot"(double* x, double* y, Py_ssize_t m) noexcept nogil
cdef double dot_sizes "lcpstep_dot_sizes"(double* x, double* y, Py_ssize_t m) noexcept nogil
cdef void subtract "lcpstep_subtract"(double* target, double* source, double factor, Py_ssize_t m) noexcept nogil
cdef void add_four "lcpstep_add_four"(
    double* target, double* x, Py_ssize_t stride, double* by, Py_ssize_t jump, Py_ssize_t m
) noexcept nogil
cdef void ratios "lcpstep_ratios"(
    double* target, double* x, double slack, double* d, double smallest, Py_ssize_t m
) noexcept nogil
cdef void excesses "lcpstep_excesses"(
    double* target, double* x, double bound, double* d, double smallest, Py_ssize_t m
) noexcept nogil
cdef void raise_to "lcpstep_raise_to"(double* target, double* x, double factor, Py_ssize_t m) noexcept nogil
cdef long long largest_magnitude "lcpstep_largest_magnitude"(double* x, Py_ssize_t m) noexcept nogil
cdef long long larger(long long a, long long b) noexcept nogil
cdef void turn_four "lcpstep_turn_four"(
    double* target, double* x, double* by, double* c, Py_ssize_t stride, Py_ssize_t m
) noexcept nogil
cdef void multiply "lcpstep_multiply"(double* target, double factor, Py_ssize_t m) noexcept nogil
cdef void copy(double* target, double* source, Py_ssize_t m) noexcept nogil
cdef double largest_entry "lcpstep_largest_entry"(double* x, Py_ssize_t m) noexcept nogil
cdef double lowest_entry "lcpstep_lowest_entry"(double* x, Py_ssize_t m) noexcept nogil
