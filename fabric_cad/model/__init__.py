"""From measured rows to the solved table: the paper's identification."""
