"""Gauss' rule with four nodes on [0, 1], for kernels: weights are the same for the outer and for the inner two."""

NODE_0, NODE_1, NODE_2, NODE_3 = (
    0.06943184420297371,
    0.33000947820757187,
    0.6699905217924281,
    0.9305681557970263,
)
OUTER, INNER = 0.17392742256872692, 0.32607257743127307
