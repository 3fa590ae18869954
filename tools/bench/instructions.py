"""Instructions that fixed runs of rotid execute in its own code, by callgrind, beside those recorded in instructions.txt: what is more
than 5 % above them fails; and those of rotid_lm beside lmder of MINPACK, all libraries included, of which 1.2 times as many fail. Time spent in libraries is left out: which of their kernels run depends on the processor. Arguments:
program, generator, folder; --record writes the counts anew."""
import pathlib
import subprocess
import sys

rotid, hide, folder = sys.argv[1:4]
record = pathlib.Path(__file__).with_name("instructions.txt")
MOST = 1.05

hidden = folder + "/bench.inp"
subprocess.run([hide, "input/paper_rotor.inp", "-o", hidden, "--truth", folder + "/bench.truth", "--seed", "1", "--effect",
                "stiffness_local:depth=0.5,z=0.857,width=0.03,shape=gaussian"], check=True)
full = folder + "/bench_full.inp"
text = pathlib.Path(hidden).read_text()
pathlib.Path(full).write_text("".join("*FIT, FUNCTIONAL=LIKELIHOOD, REDUCTION=NONE, MODES=1-6\n" if line.startswith("*FIT") else line
                                      for line in text.splitlines(keepends=True)))
RUNS = {
    "identify, condensed": ["identify", "input/paper_rotor.inp", "--no-baseline"],
    "identify, full, shapes": ["identify", full, "--no-baseline"],
    "diagnose, 6 modes": ["diagnose", "input/brake_reuss_beam.inp", "--threads", "1"],
    "diagnose, 68 sensors": ["diagnose", hidden, "--threads", "1"],
    "modes of a solid": ["modes", "input/converged_steel.inp"],
}


def count(arguments):
    """Sum of the costs of the lines whose object is the program itself."""
    out = pathlib.Path(folder) / "instructions.callgrind"
    subprocess.run(["valgrind", "-q", "--tool=callgrind", f"--callgrind-out-file={out}", rotid, *arguments, "--quiet", "--json",
                    folder + "/instructions.json"], check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    names, own, called, total = {}, False, False, 0
    with out.open() as lines:
        for line in lines:
            if line.startswith(("ob=", "cob=")): # a name stands where its number is met first
                number, _, name = line[line.index("=") + 1:].strip().partition(" ")
                names[number] = name or names[number]
                if line.startswith("ob="):
                    own = names[number].endswith("/rotid")
            elif line.startswith("calls="):
                called = True # the cost on the next line is that of the function called
            elif line[:1].isdigit() or line[:1] in "+-*":
                if own and not called:
                    total += int(line.split()[1])
                called = False
    return total


counts = {name: count(arguments) for name, arguments in RUNS.items()}
if "--record" in sys.argv[4:]:
    record.write_text("".join(f"{value}\t{name}\n" for name, value in counts.items()))
before = {name: int(value) for value, name in (line.split("\t") for line in record.read_text().splitlines())}
failed = 0
print(f"{'instructions of rotid itself, in millions':44}{'recorded':>10}{'now':>10}{'ratio':>8}")
for name, value in counts.items():
    ratio = value / before[name] if name in before else float("inf")
    failed += ratio > MOST
    print(f"{name:44}{before.get(name, 0) / 1e6:10.1f}{value / 1e6:10.1f}{ratio:8.3f}{'  FAILED' if ratio > MOST else ''}")
passed, minimiser = len(counts) - failed, pathlib.Path(folder) / "lm_host"
if minimiser.exists():
    both = [subprocess.run(["valgrind", "--tool=callgrind", "--collect-atstart=no", "--callgrind-out-file=/dev/null", minimiser, which],
                           check=True, capture_output=True, text=True) for which in ("rotid_lm", "lmder")]
    own, peer = (int(run.stderr.split("Collected :")[1].split()[0]) for run in both)
    bad = own > 1.2 * peer or int(both[0].stdout) < int(both[1].stdout)
    print(f"rotid_lm {own / 1e6:.1f}, lmder {peer / 1e6:.1f} million instructions: {own / peer:.2f}; of 54 starts of NIST's problems "
          f"solved {int(both[0].stdout)}, {int(both[1].stdout)}{'  FAILED' if bad else ''}")
    passed, failed = passed + (not bad), failed + bad
print(f"{passed} passed, {failed} failed")
sys.exit(failed > 0)
