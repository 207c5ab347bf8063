"""A row's cell from start to end, its report, and where results come from."""
