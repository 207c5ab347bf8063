"""Flow between the yarns of a cell: the permeability tensor."""
