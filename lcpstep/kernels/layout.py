"""Places in what kernels write of a run (`record`)."""

# In a row: its time, whether the contact is closed (of `Located`: whether velocities may have jumped here), duration
# of the step that follows; then q, v, impulses
TIME, MODE, LENGTH, LEAD = range(4)
COLUMNS = 6  # of an event: time, contact, gap velocity before and after, impulse, kind
