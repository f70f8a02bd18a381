"""A judge of random scenes: every method against the others and against what physics demands."""
