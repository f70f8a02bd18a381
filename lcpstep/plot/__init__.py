"""Pictures of trajectories. Everything here returns a matplotlib figure and saves or shows nothing."""
