"""Error bars of random scenes against true errors."""
