cdef class RubbingSteps(Strides):
