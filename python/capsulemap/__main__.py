"""``python -m capsulemap`` is the command line."""

from ._command import main

main()
