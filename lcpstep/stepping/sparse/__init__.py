"""The theta-method for large sparse linear systems, on whole vectors.

steps, equations, blows     frictionless: a step and its problem, what it multiplies with, who takes part in it
coupled, coulomb, stiction  with joints or friction; `path` finds the modes of contacts, `updates` its lines
"""
