from lcpstep.arrays cimport doubles
from lcpstep.lcp.judge cimport proves_infeasible
from lcpstep.lcp.lemke cimport lemke
from lcpstep.lcp.scaling cimport equilibrate
from lcpstep.lcp.workspace cimport Workspace
from lcpstep.pointers cimport after
from lcpstep.rows cimport copy

cdef Py_ssize_t RAY, PIVOTS, LARGEST
cdef double SMALLEST_PIVOT
