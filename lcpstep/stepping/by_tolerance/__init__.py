"""Steps of `Moreau` and `Located` chosen by a tolerance.

control, sizes              one step of h is compared with two of h/2; what Python sees of their sizes
moreau; located, located_parts        what a step and its two halves do, and how far they are apart
hidden_forces, hidden_switches, hidden_edges    what that comparison does not show
"""
