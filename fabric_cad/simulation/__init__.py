"""The cell under load: settings, decks through CalculiX, and what the results say.

``settings`` reads ``simulation.toml``; ``tension`` and ``shear`` name the states and turn results
into tables; ``job`` takes one deck through the ``solver`` and reads its ``results``;
``penetration`` measures deformed yarns against each other; ``run`` makes a row's files.
"""
