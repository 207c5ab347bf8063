"""``python -m fabric_cad``."""

import sys

from .cli import main

if __name__ == "__main__":  # a worker process imports it under another name
    sys.exit(main())
