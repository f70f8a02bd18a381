"""Where kernels write what a run of a system with modes keeps: places in a row, and in a line of its log."""

TIME, LENGTH, ROW_MODE, LEAD = range(4)  # time, duration and mode of the step that follows; then the state
SWITCH_LEAD = 4  # time, modes left and entered, guard; then the states before and after
