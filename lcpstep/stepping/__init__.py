"""Time-stepping: impacts happen somewhere within a step, and complementarity problems decide how.

moreau, moreau_run       Moreau's theta-method, and a run of it; its steps: `theta_method`
sparse                   the same for large systems: `sparse_equations`, `sparse_blows`; with joints or friction
                         `sparse_coupled`, `sparse_coulomb`, `sparse_stiction`, `sparse_path`, `sparse_updates`
located, pieces          impacts at their own times: method, and a run with its steps
rubbing                  the same with friction or joints
step_control             steps by a tolerance: `moreau_by_tolerance`, `located_by_tolerance` (`located_parts`);
                         `hidden_forces`, `hidden_switches`: what forces hide; `adaptive`: their sizes
step_run                 what runs by steps share; what all runs do: `lcpstep.running`
steps, extent            what all steps agree on; lengths whose rounding gaps have
interpolation, again     states between kept ones; `hidden_edges`: obstacles' edges that steps by a tolerance pass
"""
