"""Time-stepping: impacts happen somewhere within a step, and complementarity problems decide how.

moreau, moreau_run       Moreau's theta-method, and a run of it; its steps: `theta_method`
sparse                   the same for large systems
located, pieces          impacts at their own times: method, and a run with its steps
rubbing                  the same with friction or joints
by_tolerance             steps of both by a tolerance
step_run                 what runs by steps share; what all runs do: `lcpstep.running`
steps, extent            what all steps agree on; lengths whose rounding gaps have
interpolation, again     states between kept ones
"""
