"""What every method's kernels share: the scene as they see it, its equations, records, linear algebra, the clock."""
