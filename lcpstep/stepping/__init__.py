"""Time-stepping: impacts happen somewhere within a step, and complementarity problems decide how.

moreau, theta            Moreau's theta-method: method and step; `newton` for nonlinear systems, `constrained`,
`joints`, `friction` and `projection` for what a scene has besides contacts, `sparse`
for large ones
located, pieces          impacts at their own times: method, and the kernels of its steps
step_control             steps by a tolerance: `moreau_by_tolerance`, `located_by_tolerance`; `hidden_forces`,
                         `hidden_switches`: what forces hide
"""
