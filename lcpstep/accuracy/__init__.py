"""What judges results: error measures, references, orders, work-precision studies, horizons of prediction."""
