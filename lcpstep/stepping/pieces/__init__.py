"""Steps with located impacts, as kernels: pieces of smooth motion between events, each at its own time in a step.

run, prepare, state      a run; what it starts from: constants of steps, the piece at hand and work space
loop, keep               the start, and the loop over steps and pieces, which all orders share; the states kept
quadratic_steps          order 2: `piece`, its motion (`smooth`) and its gaps (`lcpstep.kernels.quadratic`)
polynomial_steps         order 4 and "exact": `polynomial`, `scan` for events, `polynomial_forces`
event, impulses, chosen  an impact, the impulses of those that fire together, their problem (`refine`: to the last
                         digit; `independent`: in parts that know nothing of each other); `corners`; `jumps`
contact_forces           of the contacts that rest; `switches` closes and opens them, `magnitudes` tells rounding
sequences, settle        how chattering ends; events without end
race, glide              impacts of many bodies in free flight; steps without events
carried                  coordinates of a moving frame
codes, times             codes of the loop; times to rounding
"""
