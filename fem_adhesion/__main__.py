"""``python -m fem_adhesion``: the command line."""

import sys

from fem_adhesion.cli import main

sys.exit(main())
