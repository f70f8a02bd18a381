"""`python -m lcpstep.cli`."""

import sys

from lcpstep.cli import main

sys.exit(main())
