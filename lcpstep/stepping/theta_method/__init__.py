"""The Moreau theta-method, as kernels.

theta_loop, theta_step    the loop over steps; a step; `moving`, its constants, state and rows
row_impulses, blows       impulses of the rows that take part; blows one after another; `reached`, whom they reach
implicit, responses       Newton's iteration of nonlinear systems; what impulses make of velocities
one_contact               one coordinate and contact, in registers
joint_rows                joints eliminated; `turned_rows`, those that they turn within the step
idle                      contacts that bear nothing by turns, beside joints
repair                    states put back onto joints and obstacles
codes                     numbers of the loop
"""
