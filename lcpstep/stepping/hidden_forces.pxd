cdef double UNSURE

cdef double late(
    double one, double first, double second, double length, double opened, double end
) noexcept nogil
cdef double gives_out(double one, double first, double second, double length, double end) noexcept nogil
cdef double hidden(double p, double q) noexcept nogil
