"""The progress of a long call as one line of plain text, on terminals and in notebooks."""

import sys


def teller(progress):
    """The function of (fraction, text) for an argument `progress`; None: no progress is shown."""
    if progress is None or progress is False:
        return None
    if progress is True:
        return _line
    if not callable(progress):
        raise TypeError(
            f"progress is {progress!r:.100}, expected True, a function of (fraction, text) or None"
        )
    return progress


def _line(fraction, text):
    """Writes on standard error, over the line written before; a fraction of 1 ends the line."""
    end = "\n" if fraction >= 1 else ""
    sys.stderr.write(f"\r{100 * fraction:3.0f} %  {text[:60]:60}{end}")
    sys.stderr.flush()
