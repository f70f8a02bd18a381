"""What motions have in common and what sets them apart: errors, references, horizons."""
