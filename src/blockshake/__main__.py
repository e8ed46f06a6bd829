"""``python -m blockshake`` is the command line."""

import sys

from blockshake.cli import main

sys.exit(main())
