"""rotid from Python: commands on decks, rotors of other programs as decks, rotors of rotid for ROSS. Reference: docs/python.md."""
from .abaqus import from_abaqus
from .draws import draws, stochastic
from .nastran import from_nastran
from .program import Message, Result, RotidError, run
from .ross import from_ross, to_ross
from .rotor import Part, Rotor, write_deck

__all__ = ["Message", "Part", "Result", "Rotor", "RotidError", "draws", "from_abaqus", "from_nastran", "from_ross", "run", "stochastic",
           "to_ross", "write_deck"]
