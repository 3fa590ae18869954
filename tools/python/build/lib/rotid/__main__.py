"""python -m rotid SOURCE -o DECK: a rotor of ROSS (.json), Nastran (.bdf, .dat, .nas) or Abaqus and CalculiX (.inp) as a deck."""
import argparse
import os
import signal
import sys
import warnings

from . import RotidError, from_abaqus, from_nastran, from_ross, write_deck
from .program import visible

READERS = {".json": from_ross, ".bdf": from_nastran, ".dat": from_nastran, ".nas": from_nastran, ".inp": from_abaqus}


def stop(number, _):
    raise SystemExit(128 + number)


def main():
    parser = argparse.ArgumentParser(prog="python -m rotid", description=__doc__)
    parser.add_argument("source", help="the file of the other program")
    parser.add_argument("-o", "--output", required=True, metavar="DECK", help="the deck")
    parser.add_argument("--units", choices=("SI", "MM"), default="SI", help="of Nastran and Abaqus files: m, kg, N, or mm, t, N, MPa")
    parser.add_argument("--program", help="rotid, where it is not on the PATH")
    given = parser.parse_args()
    signal.signal(signal.SIGTERM, stop)
    signal.signal(signal.SIGINT, stop)
    warnings.showwarning = lambda message, *_: print(visible(f"rotid: {message}"), file=sys.stderr)
    reader = READERS.get(os.path.splitext(given.source)[1].lower())
    try:
        if not reader:
            raise RotidError([f"{given.source}: expected a file {', '.join(READERS)}"])
        if os.path.exists(given.output) and os.path.samefile(given.source, given.output):
            raise RotidError([f"{given.output} is the file that is read, expected another one for the deck"])
        rotor = reader(given.source) if reader is from_ross else reader(given.source, units=given.units)
        write_deck(rotor, given.output, given.program)
    except RotidError as error:
        print("\n".join(visible(f"rotid: {m}") for m in error.messages), file=sys.stderr)
        return error.code
    except OSError as error:
        print(visible(f"rotid: {given.source}: {error.strerror or error}"), file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
