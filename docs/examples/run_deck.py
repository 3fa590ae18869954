# Runs a deck from Python: cffi reads the header itself, so nothing has to be declared again.
import subprocess, sys
from cffi import FFI

def pkg_config(variable):
    return subprocess.check_output(["pkg-config", "--variable=" + variable, "rotid"], text=True).strip()

ffi = FFI()
header = ["cc", "-E", "-P", "-D__attribute__(x)=", "-D_STDDEF_H", pkg_config("includedir") + "/rotid.h"]
ffi.cdef(subprocess.check_output(header, text=True))
rotid = ffi.dlopen(pkg_config("libdir") + "/librotid.so")

deck, found, failure = ffi.new("rotid_deck **"), ffi.new("rotid_identification **"), ffi.new("char[512]")
if rotid.rotid_deck_read(sys.argv[1].encode(), 0, ffi.NULL, ffi.NULL, failure, deck) != rotid.ROTID_OK:
    sys.exit(ffi.string(failure).decode())
if rotid.rotid_identify(deck[0], 0, ffi.NULL, failure, found) != rotid.ROTID_OK:
    sys.exit(ffi.string(failure).decode())
for i in range(found[0].nparameters):
    p = found[0].parameters[i]
    print(f"{ffi.string(p.name).decode()} {p.value:.6g}, 95 % interval {p.ci95[0]:.6g} ... {p.ci95[1]:.6g}")
rotid.rotid_identification_free(found[0])
rotid.rotid_deck_free(deck[0])
