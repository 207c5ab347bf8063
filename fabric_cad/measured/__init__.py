"""What is read from family tables and drafts: columns, rows, and the rules of a row."""
