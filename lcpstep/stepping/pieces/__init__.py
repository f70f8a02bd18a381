"""Steps with located impacts, as kernels: pieces of smooth motion between events, each at its own time in a step."""
