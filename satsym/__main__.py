"""``python -m satsym``: the command line without its console script."""

import sys

from satsym.cli import main

sys.exit(main())
