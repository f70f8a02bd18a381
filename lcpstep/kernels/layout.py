"""Places in what kernels write of a run (`record`)."""

COLUMNS = 6  # of an event: time, contact, gap velocity before and after, impulse, kind
