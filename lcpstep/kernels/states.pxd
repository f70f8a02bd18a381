from lcpstep.kernels.model cimport Model

cpdef extremes(Model m, object t, object q, object v)
cpdef gaps_at(Model m, object t, object q)
cpdef own_rates(Model m, object t, object q, object v, bint moved)
cpdef power(Model m, object t, object q, object v)
cpdef energy(Model m, object t, object q, object v)
cpdef accelerations(Model m, object t, object q, object v)
cpdef responses(Model m, object t, object q, object v)
