"""Time-stepping: impacts happen somewhere within a step, and complementarity problems decide how."""
