"""``python -m fabric_cad``."""

import sys

from .cli import main

sys.exit(main())
