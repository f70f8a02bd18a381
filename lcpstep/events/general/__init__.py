"""Systems with any number of contacts and joints: complementarity problems at impacts and in lasting contact."""
