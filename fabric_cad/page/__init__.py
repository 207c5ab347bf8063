"""A fabric on a page: a row that is edited, what it is told at once, and the page that draws it."""
