"""Time-stepping: impacts happen somewhere within a step, and complementarity problems decide how.

moreau, theta            Moreau's theta-method: method and step; `newton` for nonlinear systems, `constrained`,
`joints`, `friction` and `projection` for what a scene has besides contacts, `sparse`
for large ones
located, located_loop    impacts at their own times: method and loop; `located_piece` for the motion between two
events (`smooth`, `contact_forces`), `located_event` for an impact (`impulses`,
`refine`), `race` for many, `located_joints`; `polynomial_loop` for order 4 and "exact"
adaptive                 steps by a tolerance: `adaptive_moreau`, `adaptive_located`; `adaptive_forces` and
`adaptive_switches` for what contact forces hide
"""
