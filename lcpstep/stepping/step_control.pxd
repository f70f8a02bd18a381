cimport cython
from lcpstep.kernels.course cimport Course
from lcpstep.kernels.record cimport Record

cdef Py_ssize_t LEVELS, ROWS, REACHED, PAUSED, TOO_SMALL, WANTED, ACCEPTED, AGAIN, GIVEN_UP, JUMPS
cdef double NOISE, LATE, PLENTY, LEAST_SHARE, FLAT


cdef class Control(Course):
    cdef Record record
    cdef object make, matrices, own_made
    cdef Py_ssize_t n_times, row, event, asked, jumped
    cdef Py_ssize_t* made
    cdef public long long position, until, end, tried
    cdef public int level, finest
    cdef public double start, stop, span, h_max, tolerance, enough, size_q, size_v, last, into
    cdef public double apart_q, apart_v, far_q, far_v, rate, cut
    cdef public bint happened, failed, hopeless, full
    cdef void store(self) noexcept nogil
    cdef void restore(self) noexcept nogil
    cdef void mark(self) noexcept nogil
    cdef void wind_back(self) noexcept nogil
    cdef void accept(self) noexcept nogil
    cdef Py_ssize_t attempt(self) noexcept nogil
    cdef Py_ssize_t stage(self, Py_ssize_t goal) noexcept nogil
    cdef Py_ssize_t refusal(self) noexcept nogil
    cdef Py_ssize_t move(self) noexcept nogil
    cdef void begin_attempt(self) noexcept nogil
    cdef double step_size(self, int level) noexcept nogil
    @cython.locals(one=cython.longlong)
    cdef long long length(self, int level) noexcept nogil
    cdef double base(self) noexcept nogil
    cdef double now(self) noexcept nogil
    cdef double goal(self) noexcept nogil
    cdef double time_of(self, long long position) noexcept nogil
    cdef bint over(self) noexcept nogil
    cdef double resolved(self, double size) noexcept nogil
    @cython.locals(jumps=bint)
    cdef Py_ssize_t judge(self) noexcept nogil
    cdef bint pass_by(self, double time) noexcept nogil


cdef void stamp(Record r, Py_ssize_t row, Py_ssize_t event, double late, double t) noexcept nogil
cdef void follow_on(Record r, Py_ssize_t row) noexcept nogil
