"""Systems with several contacts or joints: complementarity problems at impacts and in lasting contact."""
