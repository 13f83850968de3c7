"""Runs the program `p2m`: ``python -m p2m info scene.ply``."""

import sys

from . import _p2m

if __name__ == "__main__":
    sys.exit(_p2m.main(["p2m", *sys.argv[1:]]))
