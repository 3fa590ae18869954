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
for p in range(found[0].nparameter):
    name, fit = ffi.string(found[0].parameter[p].name).decode(), found[0].fit
    print(f"{name} {fit.x[p]:.6g}, 95 % interval {fit.ci_lower[p]:.6g} ... {fit.ci_upper[p]:.6g}")
rotid.rotid_identification_free(found[0])
rotid.rotid_deck_free(deck[0])
